// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/detail/leader_inertia.hpp"

#include <cstdio>

#include "softgauss/engine/core/index.hpp"

namespace softgauss::detail {
namespace {

bool carriesMass(const Model& model, int body) {
  for (int i = body; i < model.bodies[idx(body)].subtreeEnd; ++i)
    if (model.bodies[idx(i)].mass > 0.0) return true;
  return false;
}

/// M_ii of a body's joint of one degree of freedom, all joints of its subtree at zero.
double ownInertia(const Model& model, int body) {
  const Body& top = model.bodies[idx(body)];
  std::vector<Transform> X_TB(idx(top.subtreeEnd - body));  // poses in the top body
  double sum = model.dofs[idx(top.v)].armature;
  for (int i = body; i < top.subtreeEnd; ++i) {
    const Body& b = model.bodies[idx(i)];
    if (i > body) X_TB[idx(i - body)] = X_TB[idx(b.parent - body)] * b.X_PB;
    if (b.massless) continue;
    if (top.joint == JointKind::prismatic) {
      sum += b.mass;
    } else {
      const Vector3 axis = X_TB[idx(i - body)].R.transpose() * top.axis;
      const Vector3 arm = top.axis.cross(X_TB[idx(i - body)] * b.com);
      sum += axis.dot(b.I_Bcm.matrix() * axis) + b.mass * arm.squaredNorm();
    }
  }
  return sum;
}

/// What those that follow a joint, directly or by way of others, put on it.
double reflected(const Model& model, int leader) {
  double sum = 0.0;
  for (const JointCoupling& c : model.couplings) {
    if (c.leader != leader) continue;
    const double slope = c.slope(0.0);
    sum += slope * slope * (ownInertia(model, c.follower) + reflected(model, c.follower));
  }
  return sum;
}

}  // namespace

void addLeaderArmature(Model& model) {
  std::string told;
  for (int b = 1; b < model.bodyCount() && !model.couplings.empty(); ++b) {
    const Body& body = model.bodies[idx(b)];
    if (body.dofs != 1 || model.dofs[idx(body.v)].armature > 0.0 || carriesMass(model, b)) continue;
    const double share = kLeaderShare * reflected(model, b);
    if (!(share > 0.0)) continue;
    model.dofs[idx(body.v)].armature = share;
    char text[48];
    std::snprintf(text, sizeof text, " (%.3g %s)", share,
                  body.joint == JointKind::prismatic ? "kg" : "kg m²");
    told += (told.empty() ? " " : ", ") + model.jointNames[idx(b)] + text;
  }
  if (!told.empty())
    model.warnings.push_back(
        "joints that move no mass but that of joints which follow them have an armature of a "
        "hundredth of it:" +
        told);
}

}  // namespace softgauss::detail
