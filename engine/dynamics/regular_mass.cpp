// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/regular_mass.hpp"

#include <cmath>
#include <cstdio>

#include "softgauss/engine/core/index.hpp"

namespace softgauss {
namespace {

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

/// The body that makes up M_ii of a dof, where that of all others together vanishes beside it; −1
/// where no body does, or there is but one.
int overwhelming(const Model& model, const Kinematics& k, const MassMatrix& inertia, int dof) {
  constexpr double kVanishes = 1e-10;
  const int top = model.dofs[idx(dof)].body;
  int largest = -1, count = 0;
  double most = 0.0, all = 0.0;
  for (int b = top; b < model.bodies[idx(top)].subtreeEnd; ++b) {
    if (model.bodies[idx(b)].massless) continue;
    const Motion& S = k.S[idx(dof)];
    const double share = dot(S, inertia.body[idx(b)] * S);
    all += share;
    ++count;
    if (share > most) {
      most = share;
      largest = b;
    }
  }
  return count > 1 && all - most <= kVanishes * most ? largest : -1;
}

SingularMass tooLarge(const Model& model, int body) {
  const Body& b = model.bodies[idx(body)];
  const std::string& name = model.bodyNames[idx(body)];
  return {"link '" + name + "'", name,
          "has " + number(b.mass) + " kg with their centre " + number(b.com.norm()) +
              " m from its origin, beside which the inertia of all else vanishes: the mass matrix "
              "is singular up to rounding; expected numbers of one robot; try other units"};
}

}  // namespace

int singularDof(const TreeMatrix& M, TreeFactor& factor) {
  const int failed = factor.compute(M) ? -1 : factor.failedRow();
  // What fails may do so because of a row beyond it.
  for (int i = M.size() - 1; i > failed; --i) {
    const double inverse = factor.inversePivot(i);
    if (!std::isfinite(inverse) || !(1.0 >= kSingularPivot * inverse * M.row(i)[i])) return i;
  }
  return failed;
}

std::optional<SingularMass> findSingularMass(const Model& model, const VectorX& q) {
  if (model.nv == 0) return std::nullopt;
  Kinematics k(model);
  MassMatrix inertia(model);
  computePoses(model, q, k);
  computeMassMatrix(model, k, inertia);
  TreeFactor factor;
  const int dof = singularDof(inertia.M, factor);
  if (dof < 0) return std::nullopt;
  const int b = model.dofs[idx(dof)].body;
  const Body& body = model.bodies[idx(b)];
  const std::string& link = model.bodyNames[idx(b)];
  if (body.joint == JointKind::floating && body.mass == 0.0)  // whatever moments it has
    return SingularMass{"link '" + link + "'", link,
                        "is a root that has no mass and floats: nothing resists its motion; "
                        "--base fixed? (base: fixed in a scene), or give it an <inertial> with a "
                        "mass"};
  if (const int large = overwhelming(model, k, inertia, dof); large >= 0)
    return tooLarge(model, large);
  const std::string element = body.joint == JointKind::floating
                                  ? "link '" + link + "'"
                                  : "joint '" + model.jointNames[idx(b)] + "'";
  const double own = inertia.M.row(dof)[dof];
  if (!std::isfinite(1.0 / own))
    return SingularMass{element, link,
                        "moves an inertia of " + number(own) + ", with link '" + link +
                            "', whose inverse overflows; expected more, or an armature"};
  return SingularMass{element, link,
                      "moves nothing that other joints do not move alike: the mass matrix is "
                      "singular in the initial configuration; try another start (--q0, or "
                      "joints: in a scene), or give the links between these joints an inertia"};
}

}  // namespace softgauss
