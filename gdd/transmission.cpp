// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/transmission.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace softgauss::gdd {
namespace {

/// A column of which less than this share is new depends on those before.
constexpr double kDependentColumn = 1e-10;

[[noreturn]] void fail(const Actuator& actuator, const std::string& problem) {
  throw ModelError(actuator.where, "actuator '" + actuator.name + "'", problem);
}

/// The power of two that is at most the largest coefficient.
double sizeOf(const Actuator& actuator) {
  double largest = 0.0;
  for (const Actuator::Pull& pull : actuator.pulls)
    largest = std::max(largest, std::abs(pull.coefficient));
  return std::exp2(std::ilogb(largest));
}

std::string quoted(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) text += (i ? ", '" : "'") + names[i] + "'";
  return text;
}

}  // namespace

Transmission::Transmission(int dofs, std::vector<Actuator> actuators)
    : actuators_(std::move(actuators)),
      coordinate_(actuators_.size(), -1),
      kind_(static_cast<std::size_t>(dofs), Kind::free),
      plain_(static_cast<std::size_t>(dofs), 1),
      T_(MatrixX::Identity(dofs, dofs)),
      C_(MatrixX::Identity(dofs, dofs)),
      size_(VectorX::Ones(dofs)) {
  check();
  // Dofs that actuators tie together have one representative.
  std::vector<int> parent(static_cast<std::size_t>(dofs));
  std::iota(parent.begin(), parent.end(), 0);
  const auto representative = [&](int i) {
    while (parent[static_cast<std::size_t>(i)] != i) i = parent[static_cast<std::size_t>(i)];
    return i;
  };
  for (const Actuator& actuator : actuators_) {
    for (const Actuator::Pull& pull : actuator.pulls) {
      const int a = representative(actuator.pulls.front().dof), b = representative(pull.dof);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  }
  for (int first = 0; first < dofs; ++first) {
    if (representative(first) != first) continue;
    std::vector<int> block, members;
    for (int i = first; i < dofs; ++i)
      if (representative(i) == first) block.push_back(i);
    for (std::size_t k = 0; k < actuators_.size(); ++k)
      if (representative(actuators_[k].pulls.front().dof) == first)
        members.push_back(static_cast<int>(k));
    if (!members.empty()) setBlock(block, members);
  }
}

void Transmission::check() const {
  const int dofs = static_cast<int>(size_.size());
  for (const Actuator& actuator : actuators_) {
    if (actuator.pulls.empty()) fail(actuator, "pulls nothing, expected a joint");
    if (!(actuator.lower <= actuator.upper && actuator.lower < kInfinity &&
          actuator.upper > -kInfinity))
      fail(actuator, "has bounds from " + std::to_string(actuator.lower) + " to " +
                         std::to_string(actuator.upper) +
                         ", expected lower ≤ upper, and a finite number between");
    for (const Actuator::Pull& pull : actuator.pulls) {
      if (pull.dof < 0 || pull.dof >= dofs)
        fail(actuator, "pulls dof " + std::to_string(pull.dof) + ", expected one of 0 to " +
                           std::to_string(dofs - 1));
      if (!std::isfinite(pull.coefficient) || pull.coefficient == 0.0)
        fail(actuator, "pulls with a coefficient of " + std::to_string(pull.coefficient) +
                           ", expected a finite number other than 0");
      if (std::count_if(actuator.pulls.begin(), actuator.pulls.end(),
                        [&](const auto& other) { return other.dof == pull.dof; }) > 1)
        fail(actuator, "pulls dof " + std::to_string(pull.dof) + " twice, expected once");
    }
  }
}

void Transmission::setBlock(const std::vector<int>& dofs, const std::vector<int>& members) {
  const auto k = static_cast<Eigen::Index>(dofs.size());
  const auto m = static_cast<Eigen::Index>(members.size());
  // Columns scaled to the size of 1, so that no square over- or underflows: dependence asks for
  // directions only. By powers of two, which changes no digit of what comes of them.
  MatrixX B = MatrixX::Zero(k, m);
  VectorX scale(m);
  MatrixX basis(k, 0);  // orthonormal, of the columns so far
  for (Eigen::Index c = 0; c < m; ++c) {
    const Actuator& actuator = actuators_[static_cast<std::size_t>(members[c])];
    scale[c] = sizeOf(actuator);
    for (const Actuator::Pull& pull : actuator.pulls) {
      const auto row = std::lower_bound(dofs.begin(), dofs.end(), pull.dof) - dofs.begin();
      B(row, c) = pull.coefficient / scale[c];
    }
    const VectorX column = B.col(c).normalized();
    VectorX fresh = column;
    for (int pass = 0; pass < 2; ++pass) fresh -= basis * (basis.transpose() * fresh);
    if (fresh.norm() <= kDependentColumn) {
      // Of which it is a combination: the least number of them is what the message names.
      const VectorX share = B.leftCols(c).colPivHouseholderQr().solve(B.col(c));
      std::vector<std::string> others;
      for (Eigen::Index i = 0; i < c; ++i)
        if (std::abs(share[i]) * B.col(i).norm() > kDependentColumn * B.col(c).norm())
          others.push_back(actuators_[static_cast<std::size_t>(members[i])].name);
      fail(actuator, "pulls as a combination of " + quoted(others) +
                         " does, expected actuators that are linearly independent");
    }
    basis.conservativeResize(Eigen::NoChange, c + 1);
    basis.col(c) = fresh.normalized();
  }

  const Eigen::HouseholderQR<MatrixX> qr(B);
  const MatrixX Q = qr.householderQ() * MatrixX::Identity(k, k);
  const MatrixX inverse = qr.matrixQR().topRows(m).triangularView<Eigen::Upper>().solve(
      MatrixX(Q.leftCols(m).transpose()));
  for (Eigen::Index j = 0; j < k; ++j) {
    const int y = dofs[static_cast<std::size_t>(j)];
    for (Eigen::Index i = 0; i < k; ++i) {
      const int dof = dofs[static_cast<std::size_t>(i)];
      T_(dof, y) = j < m ? B(i, j) * scale[j] : Q(i, j);
      C_(y, dof) = j < m ? inverse(j, i) / scale[j] : Q(i, j);
    }
    kind_[static_cast<std::size_t>(y)] = j < m ? Kind::command : Kind::root;
    plain_[static_cast<std::size_t>(y)] = k == 1 && T_(y, y) == 1.0;
    size_[y] = T_.col(y).cwiseAbs().maxCoeff();
    if (j < m) coordinate_[static_cast<std::size_t>(members[static_cast<std::size_t>(j)])] = y;
  }
}

}  // namespace softgauss::gdd
