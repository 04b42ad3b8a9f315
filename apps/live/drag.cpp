// SPDX-License-Identifier: Apache-2.0
#include "apps/live/drag.hpp"

#include <fmt/format.h>

namespace softgauss::live {

Drag::Drag(const Model& model, int number)
    : reach(model, model.frames.back().name, Vector3::Zero()),
      name_(fmt::format("drag {}", number)) {
  end();
}

void Drag::begin(const Model& model, const std::string& link, const Vector3& p_FP,
                 const Vector3& p_WTarget, std::optional<double> weight) {
  reach = gdd::Reach(model, link, p_WTarget, p_FP);
  if (weight) reach.weight = *weight, reach.defaultWeight.giveUp();
  line.reset();
  startTime = -kInfinity;
}

void Drag::followLine(const Vector3& p_W, double time, double duration) {
  line = BegunLine{};
  line->p_start = p_W;
  line->p_target = reach.p_WTarget;
  line->startTime = time;
  line->duration = duration;
}

void Drag::moveTo(const Vector3& p_WTarget, double time) {
  reach.p_WTarget = p_WTarget;
  if (line) line->turnTo(p_WTarget, time);
}

std::optional<gdd::LedPlace> Drag::ledPlace() const {
  std::optional<gdd::LedPlace> place = reach.ledPlace();
  if (place) place->startTime = startTime, place->endTime = endTime;
  return place;
}

/// As a reach does it along its line.
void Drag::addCost(const gdd::GoalContext& context, gdd::GoalCost& cost) const {
  if (!line) return reach.addCost(context, cost);
  const Kinematics& k = context.data.kinematics;
  const int body = context.model.frames[reach.frame].body;
  const BegunLine::Point on = line->at(context.state.time);
  const Vector3 p = reach.position(context), v = pointVelocity(context.model, k, body, p);
  const Vector3 wished = on.a + reach.stiffness * (on.p - p) + reach.damping * (on.v - v);
  cost.addPoint(context.model, k, context.data.inertia.sparsity, body, p, reach.weight,
                wished - pointBiasAcceleration(context.model, k, body, p));
}

}  // namespace softgauss::live
