// SPDX-License-Identifier: Apache-2.0
#include "apps/gdd_benchmark/scripted_operator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace softgauss::app {

/// Box and Muller.
double Random::normal() {
  const double radius = std::sqrt(-2.0 * std::log(unit()));
  return radius * std::cos(2.0 * std::numbers::pi * unit());
}

ScriptedOperator::ScriptedOperator(const Model& model, double deviate, double lowest, double weight,
                                   std::uint64_t seed)
    : model_(model), deviate_(deviate), lowest_(lowest), weight_(weight), random_(seed) {
  for (int b = 1; b < model.bodyCount(); ++b)
    if (!model.bodies[b].massless) segments_.push_back(b);
  SOFTGAUSS_ASSERT(!segments_.empty());
}

gdd::Reach ScriptedOperator::nextGoal(const Kinematics& kinematics) {
  const int body = segments_[random_.index(static_cast<int>(segments_.size()))];
  const std::string& link = model_.bodyNames[body];
  const Transform X_WF = framePose(model_, kinematics, model_.findFrame(link));
  const Vector3 p_WCom = kinematics.X_WB[body] * model_.bodies[body].com;
  Vector3 target = p_WCom;
  for (double& x : target) x += deviate_ * random_.normal();
  target.z() = std::max(target.z(), lowest_);
  gdd::Reach goal(model_, link, target, X_WF.inverse() * p_WCom);
  goal.weight = weight_;
  return goal;
}

}  // namespace softgauss::app
