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
  duration.reset();
  startTime = -kInfinity;
}

void Drag::followFrom(const Vector3& p_W, double time, double lasting) {
  duration = lasting;
  gdd::PointMotion from;
  from.p = p_W;
  comeFrom(from, time);
}

void Drag::comeFrom(const gdd::PointMotion& from, double time) {
  MatrixX p(3, 2), v = MatrixX::Zero(3, 2), a = MatrixX::Zero(3, 2);
  p << from.p, reach.p_WTarget;
  v.col(0) = from.v;
  a.col(0) = from.a;
  reach.trajectory =
      std::make_shared<gdd::KnotTrajectory>(std::vector<double>{time, time + *duration}, p, v, a);
}

void Drag::moveTo(const Vector3& p_WTarget, double time) {
  reach.p_WTarget = p_WTarget;
  if (duration) comeFrom(reach.targetAt(time), time);
}

std::optional<gdd::LedPlace> Drag::ledPlace() const {
  std::optional<gdd::LedPlace> place = reach.ledPlace();
  if (place) place->startTime = startTime, place->endTime = endTime;
  return place;
}

}  // namespace softgauss::live
