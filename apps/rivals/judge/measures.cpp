// SPDX-License-Identifier: Apache-2.0
#include "apps/rivals/judge/measures.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "apps/rivals/judge/machines.hpp"
#include "apps/rivals/judge/overlap.hpp"
#include "apps/rivals/judge/published.hpp"

namespace rivals {
namespace {

constexpr double kUm = 1e6;

/// Largest change of energy over the largest kinetic energy, in percent.
double energyError(const Scene& scene, const Trajectory& run) {
  const Energies start = energiesOf(scene, run.front());
  double off = 0.0, most = 0.0;
  for (const auto& states : run) {
    const Energies e = energiesOf(scene, states);
    off = std::max(off, std::abs(e.kinetic + e.potential - start.kinetic - start.potential));
    most = std::max(most, e.kinetic);
  }
  return 100.0 * off / most;
}

Measures smooth(const Scene& scene, const Trajectory& run) {
  return {{"energy_percent", energyError(scene, run)}};
}

/// Of the first body. Its start is known, and so is its flight.
Measures freeFlight(const Scene& scene, const Trajectory& run) {
  const BodyState& start = run.front()[0];
  const Vector3d I = scene.bodies[0].inertia;
  const auto spin = [&](const BodyState& s) -> Vector3d {
    return s.orientation * I.cwiseProduct(s.orientation.conjugate() * s.angularVelocity);
  };
  double parabola = 0.0, momentum = 0.0;
  for (std::size_t k = 0; k < run.size(); ++k) {
    const double t = static_cast<double>(k) * scene.sample;
    const Vector3d truth = start.position + t * start.velocity + 0.5 * t * t * scene.gravity;
    parabola = std::max(parabola, (run[k][0].position - truth).norm());
    momentum = std::max(momentum, (spin(run[k][0]) - spin(start)).norm());
  }
  return {{"energy_percent", energyError(scene, run)},
          {"momentum", momentum / spin(start).norm()},
          {"parabola_mm", kMm * parabola}};
}

Measures top(const Scene& scene, const Trajectory& run) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const auto& states : run) {
    const double tilt =
        std::acos(std::clamp((states[0].orientation * Vector3d::UnitZ())[2], -1.0, 1.0));
    low = std::min(low, tilt), high = std::max(high, tilt);
  }
  const auto [least, most] = tiltOfTop(scene);
  const double error = std::max(std::abs(low - least), std::abs(high - most));
  return {{"energy_percent", energyError(scene, run)},
          {"tilt_low_deg", kDegrees * low},
          {"tilt_high_deg", kDegrees * high},
          {"tilt_error_deg", kDegrees * error}};
}

/// A box that is thrown with v along a level floor stops after v²/(2 μ g).
Measures thrown(const Scene& scene, const Trajectory& run) {
  const BodyState &start = run.front()[0], &end = run.back()[0];
  const Vector3d along = start.velocity.normalized(), across = Vector3d::UnitZ().cross(along);
  const double truth = start.velocity.squaredNorm() / (2.0 * scene.friction * scene.gravity.norm());
  const Vector3d way = end.position - start.position;
  double lifted = 0.0, turned = 0.0;
  for (const auto& states : run) {
    lifted = std::max(lifted, states[0].position[2] - start.position[2]);
    turned = std::max(turned, turnOf(states[0], start));
  }
  return {{"truth_mm", kMm * truth},
          {"off_mm", kMm * (way.dot(along) - truth)},
          {"off_percent", 100.0 * (way.dot(along) / truth - 1.0)},
          {"aside_mm", kMm * std::abs(way.dot(across))},
          {"lifted_mm", kMm * lifted},
          {"turned_deg", kDegrees * turned},
          {"end_speed", end.velocity.norm()}};
}

Vector3d downhill(const Scene& scene) {
  return Vector3d(scene.gravity[0], scene.gravity[1], 0.0).normalized();
}

/// From rest down a slope steeper than the cone: ½ (g_t − μ g_n) t².
Measures slides(const Scene& scene, const Trajectory& run) {
  const double t = static_cast<double>(run.size() - 1) * scene.sample;
  const double pull = scene.gravity.head<2>().norm(), press = -scene.gravity[2];
  const double truth = 0.5 * (pull - scene.friction * press) * t * t;
  const Vector3d down = downhill(scene), way = run.back()[0].position - run.front()[0].position;
  return {{"truth_mm", kMm * truth},
          {"off_mm", kMm * (way.dot(down) - truth)},
          {"aside_mm", kMm * std::abs(way.dot(Vector3d::UnitZ().cross(down)))}};
}

/// A box on a slope within the cone stays. What it does in the second half has no start in it.
Measures creep(const Scene& scene, const Trajectory& run) {
  const std::size_t half = run.size() / 2;
  const double t = static_cast<double>(run.size() - 1 - half) * scene.sample;
  const Vector3d down = downhill(scene), way = run.back()[0].position - run[half][0].position;
  const Vector3d whole = run.back()[0].position - run.front()[0].position;
  return {{"creep_mm_s", kMm * way.dot(down) / t},
          {"aside_mm_s", kMm * std::abs(way.dot(Vector3d::UnitZ().cross(down))) / t},
          {"moved_mm", kMm * whole.head<2>().norm()}};
}

/// A ball thrown without spin slides for 2 v/(7 μ g) and rolls on at 5/7 v.
Measures rolling(const Scene& scene, const Trajectory& run) {
  const BodyState &start = run.front()[0], &end = run.back()[0];
  const double v = start.velocity.norm(), rub = scene.friction * scene.gravity.norm();
  const double t = static_cast<double>(run.size() - 1) * scene.sample,
               until = 2.0 * v / (7.0 * rub);
  const double truth = v * until - 0.5 * rub * until * until + 5.0 / 7.0 * v * (t - until);
  const Vector3d contact =
      end.velocity + end.angularVelocity.cross(Vector3d(0, 0, -scene.bodies[0].shapes[0].size[0]));
  return {{"truth_mm", kMm * truth},
          {"off_mm", kMm * ((end.position - start.position).norm() - truth)},
          {"slip_percent", 100.0 * contact.head<2>().norm() / end.velocity.norm()}};
}

Measures drop(const Scene& scene, const Trajectory& run) {
  const double radius = scene.bodies[0].shapes[0].size[0];
  double deepest = 0.0, rebound = 0.0;
  bool met = false;
  for (const auto& states : run) {
    const double gap = states[0].position[2] - radius;
    met = met || gap < 0.0;
    deepest = std::max(deepest, -gap);
    // What is before the ground is met is the fall.
    if (met) rebound = std::max(rebound, gap);
  }
  return {{"deepest_mm", kMm * deepest},
          {"rebound_mm", kMm * rebound},
          {"rest_mm", kMm * (radius - run.back()[0].position[2])},
          {"end_speed", run.back()[0].velocity.norm()}};
}

Measures tower(const Scene&, const Trajectory& run) {
  double leans = 0.0, drift = 0.0, speed = 0.0;
  const auto &first = run.front(), &last = run.back();
  for (std::size_t i = 0; i < last.size(); ++i) {
    leans = std::max(leans, turnOf(first[i], last[i]));
    drift = std::max(drift, (last[i].position - first[i].position).head<2>().norm());
    speed = std::max(speed, last[i].velocity.norm());
  }
  return {{"sinks_mm", kMm * (first.back().position[2] - last.back().position[2])},
          {"leans_deg", kDegrees * leans},
          {"drift_mm", kMm * drift},
          {"end_speed", speed}};
}

/// What has moved so far out of a grip is lost [m]: the cube is shorter, and so is the fingers'
/// reach below it.
constexpr double kLost = 0.05;

/// The last body is held by the others.
Measures grip(const Scene& scene, const Trajectory& run) {
  const auto fell = [&](std::size_t k) {
    return run.front().back().position[2] - run[k].back().position[2];
  };
  double lost = -1.0;
  for (std::size_t k = 0; k < run.size() && lost < 0.0; ++k)
    if (fell(k) > kLost) lost = static_cast<double>(k) * scene.sample;
  const std::size_t half = run.size() / 2;
  const double t = static_cast<double>(run.size() - 1 - half) * scene.sample;
  return {{"fell_mm", kMm * fell(run.size() - 1)},
          {"creep_um_s", kUm * (fell(run.size() - 1) - fell(half)) / t},
          {"turned_deg", kDegrees * turnOf(run.front().back(), run.back().back())},
          {"lost_s", lost}};
}

/// The last body is held by what the first one carries: how far it has moved in the first.
Measures carried(const Scene&, const Trajectory& run) {
  const auto heldIn = [&](std::size_t k) {
    return run[k].front().pose().inverse() * run[k].back().pose();
  };
  const Eigen::Isometry3d start = heldIn(0), end = heldIn(run.size() - 1);
  const bool lost = !((end.translation() - start.translation()).norm() < kLost);
  return {{"slipped_mm", kMm * (end.translation() - start.translation()).norm()},
          {"turned_deg",
           kDegrees * Eigen::AngleAxisd(start.linear().transpose() * end.linear()).angle()},
          {"lost", lost ? 1.0 : 0.0}};
}

/// The first body on wheels, the others, that slide until they roll. What pulls a wheel back turns
/// it: M (v₀ − v) = Σ I ω/r = v Σ I/r². The slide is over after (v₀ − v)/(μ g).
Measures cart(const Scene& scene, const Trajectory& run) {
  const BodyState &start = run.front()[0], &end = run.back()[0];
  const double t = static_cast<double>(run.size() - 1) * scene.sample;
  const double speed = start.velocity.norm(), rub = scene.friction * scene.gravity.norm();
  double turned = 0.0;
  for (std::size_t i = 1; i < scene.bodies.size(); ++i)
    turned += scene.bodies[i].inertia[1] / std::pow(scene.bodies[i].shapes[0].size[0], 2.0);
  const double rolls = speed * scene.mass() / (scene.mass() + turned),
               slides = (speed - rolls) / rub;
  const double truth = speed * slides - 0.5 * rub * slides * slides + rolls * (t - slides);
  const Vector3d along = start.velocity / speed, way = end.position - start.position;
  return {{"truth_mm", kMm * truth},
          {"off_mm", kMm * (way.dot(along) - truth)},
          {"aside_mm", kMm * std::abs(way.dot(Vector3d::UnitZ().cross(along)))},
          {"end_speed", end.velocity.norm()}};
}

/// The last body, a box, should come to stand on the ground, and press into no wall of the first on
/// the way.
Measures peg(const Scene& scene, const Trajectory& run) {
  double overlap = 0.0;
  const Shape& box = scene.bodies.back().shapes[0];
  for (const auto& states : run)
    for (const Shape& wall : scene.bodies.front().shapes)
      overlap = std::max(overlap, -distanceOf(wall, states.front().pose() * wall.pose, box,
                                              states.back().pose() * box.pose));
  const BodyState& end = run.back().back();
  const double half = scene.bodies.back().shapes[0].size[2];
  const Vector3d up = end.orientation * Vector3d::UnitZ();
  return {{"left_mm", kMm * (end.position[2] - half)},
          {"overlap_mm", kMm * overlap},
          {"leans_deg", kDegrees * std::acos(std::clamp(up[2], -1.0, 1.0))},
          {"end_speed", end.velocity.norm()}};
}

/// Of every joint, how far the two points are apart that were its anchor.
Measures rope(const Scene& scene, const Trajectory& run) {
  double gap = 0.0;
  for (const auto& states : run)
    for (const Joint& j : scene.joints) {
      const auto anchorOn = [&](int body) -> Vector3d {
        if (body < 0) return j.anchor;
        return states[static_cast<std::size_t>(body)].pose() *
               (scene.startOf(body).inverse() * j.anchor);
      };
      gap = std::max(gap, (anchorOn(j.parent) - anchorOn(j.child)).norm());
    }
  return {{"gap_mm", kMm * gap}, {"energy_percent", energyError(scene, run)}};
}

Measures pile(const Scene& scene, const Trajectory& run) {
  const auto lastSecond = static_cast<std::size_t>(std::lround(1.0 / scene.sample));
  double deepest = 0.0, atRest = 0.0, lowest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < run.size(); ++k) {
    const double depth = deepestOverlap(scene, run[k]);
    deepest = std::max(deepest, depth);
    if (k + lastSecond >= run.size()) atRest = std::max(atRest, depth);
  }
  for (const BodyState& s : run.back()) lowest = std::min(lowest, s.position[2]);
  return {{"deepest_mm", kMm * deepest},
          {"rest_mm", kMm * atRest},
          {"end_kinetic", energiesOf(scene, run.back()).kinetic},
          {"lowest_m", lowest}};
}

using Measure = Measures (*)(const Scene&, const Trajectory&);
const std::map<std::string, Measure> kMeasures = {{"smooth", smooth},
                                                  {"free", freeFlight},
                                                  {"top", top},
                                                  {"thrown", thrown},
                                                  {"slides", slides},
                                                  {"creep", creep},
                                                  {"rolling", rolling},
                                                  {"drop", drop},
                                                  {"tower", tower},
                                                  {"grip", grip},
                                                  {"rope", rope},
                                                  {"pile", pile},
                                                  {"carried", carried},
                                                  {"cart", cart},
                                                  {"peg", peg},
                                                  {"bounce", measureBounce},
                                                  {"nut", measureNut},
                                                  {"feet", measureFeet},
                                                  {"elastic", measureElastic},
                                                  {"pushed", measurePushed}};

}  // namespace

Trajectory readTrajectory(const std::string& path, std::size_t bodies) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
  constexpr std::size_t kNumbers = 13;
  const std::size_t sample = bodies * kNumbers * sizeof(double);
  if (sample == 0 || bytes.empty() || bytes.size() % sample != 0)
    throw std::runtime_error(path + ": holds no whole samples of " + std::to_string(bodies) +
                             " bodies");
  Trajectory run(bytes.size() / sample);
  const auto* x = reinterpret_cast<const double*>(bytes.data());
  for (auto& states : run)
    for (std::size_t i = 0; i < bodies; ++i, x += kNumbers)
      states.push_back({{x[0], x[1], x[2]},
                        {x[3], x[4], x[5], x[6]},
                        {x[7], x[8], x[9]},
                        {x[10], x[11], x[12]}});
  return run;
}

double startError(const Scene& scene, const Trajectory& run) {
  double most = 0.0;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const BodyState &a = scene.bodies[i].start, &b = run.front()[i];
    most = std::max({most, (a.position - b.position).norm(), (a.velocity - b.velocity).norm(),
                     (a.angularVelocity - b.angularVelocity).norm(), turnOf(a, b)});
  }
  return most;
}

Energies energiesOf(const Scene& scene, const std::vector<BodyState>& states) {
  Energies e;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Body& b = scene.bodies[i];
    const BodyState& s = states[i];
    const Vector3d w = s.orientation.conjugate() * s.angularVelocity,
                   spin = b.inertia.cwiseProduct(w);
    e.kinetic += 0.5 * (b.mass * s.velocity.squaredNorm() + w.dot(spin));
    e.potential -= b.mass * scene.gravity.dot(s.position);
    e.linear += b.mass * s.velocity;
    e.angular += b.mass * s.position.cross(s.velocity) + s.orientation * spin;
  }
  return e;
}

Measures measure(const Scene& scene, const Trajectory& run) {
  const auto found = kMeasures.find(scene.measure);
  if (found == kMeasures.end())
    throw std::invalid_argument(scene.name + ": no measure '" + scene.measure + "'");
  return found->second(scene, run);
}

double distanceOf(const Scene& scene, const Trajectory& run, const Trajectory& reference) {
  if (run.size() != reference.size()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  for (std::size_t k = 1; k < run.size(); ++k)
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      const double gyration =
          scene.bodies[i].inertia.sum() / 2.0 / scene.bodies[i].mass;  // squared
      const double turn = turnOf(run[k][i], reference[k][i]);
      sum += (run[k][i].position - reference[k][i].position).squaredNorm() + gyration * turn * turn;
    }
  return std::sqrt(sum / static_cast<double>((run.size() - 1) * scene.bodies.size()));
}

std::pair<double, double> tiltOfTop(const Scene& scene) {
  // E and the two momenta of a top that spins about its tip leave one equation for u = cos ϑ:
  //   u̇² = (1 − u²)(α − β u) − (b − a u)²,  which vanishes where it turns (Goldstein, 5.7).
  const Body& body = scene.bodies[0];
  const double arm = (body.start.position - scene.joints[0].anchor).norm();
  const double across = body.inertia[0] + body.mass * arm * arm;  // about the tip
  const Vector3d w = body.start.orientation.conjugate() * body.start.angularVelocity;
  const double spin = body.inertia[2] * w[2];
  const Vector3d axis = body.start.orientation * Vector3d::UnitZ();
  const Vector3d L = body.start.orientation * Vector3d(across * w[0], across * w[1], spin);
  const double a = spin / across, b = L[2] / across;
  const double beta = 2.0 * body.mass * scene.gravity.norm() * arm / across;
  const double alpha = (w.head<2>().squaredNorm() * across) / across + beta * axis[2];
  const auto f = [&](double u) {
    return (1.0 - u * u) * (alpha - beta * u) - (b - a * u) * (b - a * u);
  };
  // Of the interval where f ≥ 0 that holds the start, both ends.
  const auto endFrom = [&](double direction) {
    double inside = axis[2];
    constexpr double kStep = 1e-5;
    double outside = inside + direction * kStep;
    while (f(outside) > 0.0 && std::abs(outside) < 1.0)
      inside = outside, outside += direction * kStep;
    if (f(inside) < 0.0) return axis[2];  // it starts at this turning point
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (inside + outside);
      (f(middle) > 0.0 ? inside : outside) = middle;
    }
    return inside;
  };
  return {std::acos(endFrom(1.0)), std::acos(endFrom(-1.0))};
}

}  // namespace rivals
