// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/tree_rotation.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/step/integrators/implicit_forces.hpp"

namespace softgauss {

bool drives(const Tree& tree, const Data& data, const VectorX& v, const VectorX& a, double h) {
  double most = 0.0;
  for (int i = tree.firstDof; i < tree.dofEnd; ++i)
    most = std::max(
        most, std::abs(data.forces.tau[i] + data.forces.push[i]) * data.inertia.motionScale[i]);
  return h * most > 1e-3 * treeSpeed(tree, data, v, a, h);
}

bool stopsWithin(const Model& model, const Tree& tree, const Data& data) {
  const auto inTree = [&](int dof) { return dof >= tree.firstDof && dof < tree.dofEnd; };
  const double h = model.options.timestep;
  if (data.plan.hasDamping())
    for (int i = tree.firstDof; i < tree.dofEnd; ++i)
      if (h * data.plan.damping[i] * std::pow(data.inertia.motionScale[i], 2.0) > 1.0) return true;
  return std::any_of(data.plan.springs.begin(), data.plan.springs.end(), [&](const auto& spring) {
    return inTree(spring.dof) && isStiffSpring(model, data, spring);
  });
}

bool movesEvenly(const Model& model, const Tree& tree, const VectorX& v) {
  const Body& body = model.bodies[idx(tree.rootBody)];
  if (!model.isFree(tree.rootBody))
    return std::all_of(model.bodies.begin() + tree.rootBody, model.bodies.begin() + tree.bodyEnd,
                       [](const Body& b) { return b.joint == JointKind::prismatic; });
  const Symmetric3& I = body.I_Bcm;
  const bool ball = body.com.isZero(0.0) && I.xx == I.yy && I.yy == I.zz && I.xy == 0.0 &&
                    I.xz == 0.0 && I.yz == 0.0;
  return ball || v.segment<3>(body.v + 3).isZero(0.0);
}

bool isPassive(const Model& model, const Tree& tree, bool tied, const Data& data, const VectorX& v,
               const VectorX& a) {
  const bool isSingle = tree.bodyEnd == tree.rootBody + 1;
  return !tied && !isSingle && !drives(tree, data, v, a, model.options.timestep) &&
         !stopsWithin(model, tree, data);
}

double coriolisChangeRate(const Model& model, const Tree& tree, const Data& data, const VectorX& v,
                          const VectorX& a, const VectorX& change) {
  constexpr double kRounding = 1e-12;
  const double h = model.options.timestep;
  double changes[2] = {0.0, 0.0}, sizes[2] = {0.0, 0.0};  // turning, sliding
  double speeds[2] = {0.0, 0.0}, fastest = 0.0;
  const auto add = [&](int kind, int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const double root = 1.0 / data.inertia.motionScale[i];  // √M_ii
      const double speed = std::abs(v[i]) + h * std::abs(a[i]);
      changes[kind] = std::max(changes[kind], std::abs(change[i]));
      sizes[kind] = std::max(sizes[kind], h * std::abs(change[i]) * root);
      speeds[kind] = std::max(speeds[kind], speed);
      fastest = std::max(fastest, speed * root);
    }
  };
  for (int b = tree.rootBody; b < tree.bodyEnd; ++b) {
    const Body& body = model.bodies[b];
    if (body.joint == JointKind::floating) {
      add(1, body.v, body.v + 3);
      add(0, body.v + 3, body.v + 6);
    } else {
      add(body.joint == JointKind::prismatic ? 1 : 0, body.v, body.v + 1);
    }
  }
  double rate = 0.0;
  for (const int kind : {0, 1})
    if (sizes[kind] > kRounding * fastest) rate = std::max(rate, changes[kind] / speeds[kind]);
  return rate;
}

double energyRate(double change, double motion) {
  return change > 0.0 && motion > 0.0 ? 2.0 * std::sqrt(change / motion) : 0.0;
}

double treeSpeed(const Tree& tree, const Data& data, const VectorX& v, const VectorX& a, double h) {
  double speed = 0.0;
  for (int i = tree.firstDof; i < tree.dofEnd; ++i)
    speed = std::max(speed, (std::abs(v[i]) + h * std::abs(a[i])) / data.inertia.motionScale[i]);
  return speed;
}

bool mayRotateFar(const Model& model, const Tree& tree, const Data& data, const VectorX& v,
                  const VectorX& a) {
  const double h = model.options.timestep, fast = 0.003 / h;
  double slides = 0.0, lightest = kInfinity;
  for (int b = tree.rootBody; b < tree.bodyEnd; ++b) {
    if (data.kinematics.V[idx(b)].angular.squaredNorm() > fast * fast) return true;
    const Body& body = model.bodies[idx(b)];
    const bool floats = body.joint == JointKind::floating;
    for (int i = body.v + (floats ? 3 : 0); i < body.v + (floats ? 6 : 1); ++i) {
      const double ends = std::abs(v[i] + h * a[i]);
      const double root = 1.0 / data.inertia.motionScale[i];  // √M_ii
      if (body.joint == JointKind::prismatic) {
        slides = std::max(slides, ends * root);
        continue;
      }
      if (ends > fast) return true;
      lightest = std::min(lightest, root);
    }
  }
  return slides > fast * lightest;
}

}  // namespace softgauss
