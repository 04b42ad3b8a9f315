// SPDX-License-Identifier: Apache-2.0
#include "apps/rivals/judge/machines.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace rivals {
namespace {

/// The height of a ball's or a flat box's centre where it rests [m].
double restOf(const Shape& shape) {
  return shape.kind == ShapeKind::box ? shape.size[2] : shape.size[0];
}

struct Flights {
  std::vector<double> tops;  ///< after each impact, above where the body rests [m]
  double turned = 0.0;       ///< largest angle from the start on the way [rad]
};

/// The first three flights after the fall. An impact is where the body stops to fall and begins to
/// rise.
Flights flightsOf(const Trajectory& run, double rest) {
  Flights out;
  for (std::size_t k = 1; k < run.size(); ++k) {
    const BodyState& now = run[k][0];
    if (run[k - 1][0].velocity[2] < 0.0 && now.velocity[2] >= 0.0) out.tops.push_back(0.0);
    if (out.tops.size() > 3) break;
    if (!out.tops.empty()) out.tops.back() = std::max(out.tops.back(), now.position[2] - rest);
    out.turned = std::max(out.turned, turnOf(run[0][0], now));
  }
  return out;
}

/// Of the thread: the radius where the nut's balls run, and the slope there.
struct Thread {
  double radius, slope;
};
Thread threadOf(const Scene& scene) {
  const auto& parts = scene.bodies[1].shapes;
  const auto ball = std::find_if(parts.begin(), parts.end(),
                                 [](const Shape& s) { return s.kind == ShapeKind::sphere; });
  const Shape& plate = scene.bodies[0].shapes.back();
  const Vector3d normal = plate.pose.linear().col(2);
  if (ball == parts.end()) throw std::invalid_argument(scene.name + ": a nut without balls");
  return {ball->pose.translation().head<2>().norm(), normal.head<2>().norm() / normal[2]};
}

/// The turn of a pose about z, between −π and π.
double headingOf(const Isometry3d& X) { return std::atan2(X.linear()(1, 0), X.linear()(0, 0)); }

/// When a frame of a walker is lifted, by the force up on the last body: it stands while the other
/// is.
struct Stride {
  double from, to;
  bool inner;  ///< the last body is lifted, the first one stands
};
std::vector<Stride> stridesOf(const Scene& scene) {
  std::vector<Stride> strides;
  double before = 0.0;
  for (const auto& [time, force] : scene.joints.back().program) {
    if (before == 0.0) strides.push_back({time, time, force > 0.0});
    strides.back().to = time;
    before = force;
  }
  return strides;
}

/// What moves forward when a frame is lifted: the first body alone, or all the others [kg].
double swungMass(const Scene& scene, bool inner) {
  const double first = scene.bodies.front().mass;
  return inner ? scene.mass() - first : first;
}

}  // namespace

Measures measureBounce(const Scene& scene, const Trajectory& run) {
  const double rest = restOf(scene.bodies[0].shapes[0]);
  const double fall = run.front()[0].position[2] - rest;
  const auto [tops, turned] = flightsOf(run, rest);
  Measures out{{"turned_deg", kDegrees * turned}};
  double truth = fall, worst = 0.0, deepest = 0.0;
  for (int n = 1; n <= 3; ++n) {
    const auto k = static_cast<std::size_t>(n - 1);
    const double top = k < tops.size() ? tops[k] : 0.0;
    truth *= scene.restitution * scene.restitution;
    out["top" + std::to_string(n) + "_mm"] = kMm * top;
    worst = std::max(worst, std::abs(top - truth));
  }
  for (const auto& states : run) deepest = std::max(deepest, rest - states[0].position[2]);
  out["off_percent"] = 100.0 * worst / fall;
  out["deepest_mm"] = kMm * deepest;
  return out;
}

double sinkOfNut(const Scene& scene, double time) {
  // A nut that turns by θ sinks by r tan λ θ. With what the thread bears, N, and friction along it:
  //   m a = m g − N (cos λ + μ sin λ),  I θ″ = r N (sin λ − μ cos λ).
  const auto [r, slope] = threadOf(scene);
  const Body& nut = scene.bodies[1];
  const double mu = scene.friction;
  if (mu >= slope) return 0.0;
  const double lever = (1.0 + mu * slope) / (slope - mu);
  const double a =
      scene.gravity.norm() / (1.0 + nut.inertia[2] / (nut.mass * r * r) * lever / slope);
  return 0.5 * a * time * time;
}

Measures measureNut(const Scene& scene, const Trajectory& run) {
  const auto poseIn = [&](std::size_t k) { return run[k][0].pose().inverse() * run[k][1].pose(); };
  const Isometry3d start = poseIn(0), end = poseIn(run.size() - 1);
  double turned = 0.0, heading = headingOf(start);
  for (std::size_t k = 1; k < run.size(); ++k) {
    const double now = headingOf(poseIn(k));
    turned += std::remainder(now - heading, 2.0 * std::numbers::pi);
    heading = now;
  }
  const auto [r, slope] = threadOf(scene);
  const std::size_t half = run.size() / 2;
  const double time = static_cast<double>(run.size() - 1) * scene.sample;
  const double late = static_cast<double>(run.size() - 1 - half) * scene.sample;
  const Vector3d way = start.translation() - end.translation();
  const double truth = sinkOfNut(scene, time);
  return {{"truth_mm", kMm * truth},
          {"off_mm", kMm * (way[2] - truth)},
          {"creep_mm_s", kMm * (poseIn(half).translation()[2] - end.translation()[2]) / late},
          {"turned_deg", kDegrees * turned},
          {"off_thread_mm", kMm * std::abs(way[2] + slope * r * turned)},
          {"aside_mm", kMm * way.head<2>().norm()},
          {"leans_deg", kDegrees * std::acos(std::clamp(end.linear()(2, 2), -1.0, 1.0))}};
}

double wayOfFeet(const Scene& scene) {
  // Forward force over what swings, piecewise constant: speed and way of each piece. What goes
  // forward is the first body where the force is negative, the rest where it is positive.
  const auto& program = scene.joints.front().program;
  const std::vector<Stride> strides = stridesOf(scene);
  double inner = 0.0, outer = 0.0;
  for (const Stride& s : strides) {
    double speed = 0.0, way = 0.0;
    for (std::size_t i = 0; i + 1 < program.size(); ++i) {
      if (program[i].first < s.from || program[i].first > s.to || program[i].second == 0.0)
        continue;
      const double t = program[i + 1].first - program[i].first;
      const double a = (s.inner ? 1.0 : -1.0) * program[i].second / swungMass(scene, s.inner);
      way += speed * t + 0.5 * a * t * t;
      speed += a * t;
    }
    (s.inner ? inner : outer) += way;
  }
  if (!(std::abs(inner - outer) < 1e-9))
    throw std::invalid_argument(scene.name + ": its frames do not walk alike");
  return inner;
}

Measures measureFeet(const Scene& scene, const Trajectory& run) {
  const auto sampleAt = [&](double t) {
    return std::min(static_cast<std::size_t>(std::lround(t / scene.sample)), run.size() - 1);
  };
  const Vector3d along = scene.joints.front().axis, across = Vector3d::UnitZ().cross(along);
  const double truth = wayOfFeet(scene);
  double off = 0.0, aside = 0.0, turned = 0.0, slip = 0.0;
  for (const std::size_t i : {std::size_t{0}, scene.bodies.size() - 1}) {
    const Vector3d way = run.back()[i].position - run.front()[i].position;
    const double error = way.dot(along) - truth;
    if (std::abs(error) > std::abs(off)) off = error;
    aside = std::max(aside, std::abs(way.dot(across)));
    turned = std::max(turned, turnOf(run.front()[i], run.back()[i]));
  }
  for (const Stride& s : stridesOf(scene)) {
    const std::size_t stands = s.inner ? 0 : scene.bodies.size() - 1, from = sampleAt(s.from);
    for (std::size_t k = from; k <= sampleAt(s.to); ++k)
      slip =
          std::max(slip, (run[k][stands].position - run[from][stands].position).head<2>().norm());
  }
  return {{"truth_mm", kMm * truth},
          {"off_mm", kMm * off},
          {"aside_mm", kMm * aside},
          {"turned_deg", kDegrees * turned},
          {"slip_mm", kMm * slip}};
}

}  // namespace rivals
