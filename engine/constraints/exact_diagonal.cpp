// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/exact_diagonal.hpp"

#include <algorithm>

namespace softgauss {
namespace {

/// Least share of the constant regulariser. Nothing moves along a row with less, such as the one
/// across the plane of a planar linkage; hard as 1/R it would turn its rounding into forces.
constexpr double kStiffest = 1e-9;

}  // namespace

bool ExactDiagonal::apply(const TreeMatrix& M, Constraints& constraints) {
  if (!factor_.compute(M)) return false;
  // `D` is what the constant weights have made of it.
  const auto stiffness = [&](const auto& effect, int row, double perInertia, double D) {
    row_.setZero();
    effect.addRow(row, 1.0, row_);
    solved_ = row_;
    factor_.solve(solved_);
    return 1.0 / std::max({kSmallestRegulariser, kStiffest / D, perInertia * row_.dot(solved_)});
  };
  constraints.visitAllButContacts([&](auto& effect) {
    for (int i = 0; i < effect.rowCount(); ++i)
      if (effect.perInertia[i] != 0.0)
        effect.D[i] = stiffness(effect, i, effect.perInertia[i], effect.D[i]);
  });
  PyramidalContact& pyramids = constraints.contact;
  for (const ContactRows& made : pyramids.contactsWithRows()) {
    if (pyramids.perInertia[made.row] == 0.0) continue;
    const double D =
        stiffness(pyramids, made.row, pyramids.perInertia[made.row], pyramids.D[made.row]);
    std::fill_n(pyramids.D.begin() + made.row, std::max(1, 2 * made.frictionDim), D);
  }
  EllipticContact& cones = constraints.ellipticContact;
  for (int i = 0; i < static_cast<int>(cones.contactsWithRows().size()); ++i) {
    const double perInertia = cones.perInertia(i);
    if (perInertia != 0.0)
      cones.setNormalStiffness(
          i, stiffness(cones, cones.contactsWithRows()[i].row, perInertia, cones.cone(i).D));
  }
  return true;
}

}  // namespace softgauss
