// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/standing.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/collision/lowest_point.hpp"
#include "softgauss/io/simulation/base_notes.hpp"

namespace softgauss::app {
namespace {

constexpr double kComesToStand = 0.1;  // [s] after the first contact
constexpr double kStillTouches = 0.1;  // [s] without contact: it bounces or rolls
constexpr double kStillLies = 1.0;     // [s] without contact of links that do not stand
constexpr double kFallenShare = 0.25;  // of the base's height
constexpr double kSunkShare = 0.05;    // of it: less is no way from standing to lying
constexpr double kFallenTilt = M_PI / 9.0;
constexpr double kTippedTilt = M_PI / 36.0;  // of what stood flat on its root
constexpr double kFallSpeed = 0.2;           // [m/s]
constexpr double kLiesTilt = M_PI / 3.0;
constexpr double kToldSlide = 1e-3;  // [m]

}  // namespace

Standing::Standing(const Model& model, const Kinematics& start)
    : model_(model), contactLinks_(model), links_(static_cast<std::size_t>(contactLinks_.size())) {
  const double gravity = model.options.gravity.norm();
  up_W = gravity > 0.0 ? Vector3(-model.options.gravity / gravity) : Vector3::UnitZ();
  std::vector<int> robotOf(model.bodies.size(), -1);
  for (int t = 0; t < static_cast<int>(model.trees.size()); ++t) {
    const Tree& tree = model.trees[t];
    const bool articulated = tree.bodyEnd - tree.rootBody > 1;  // else an object
    if (!model.floats(t) || !articulated || gravity == 0.0) continue;
    Robot robot;
    robot.tree = t;
    robot.body = tree.rootBody;
    robot.up_B = start.X_WB[tree.rootBody].R.transpose() * up_W;
    robot.height = heightOf(robot, start);
    robot.stoodOnRoot = looksBolted(model, start, t);
    std::fill(robotOf.begin() + tree.rootBody, robotOf.begin() + tree.bodyEnd,
              static_cast<int>(robots_.size()));
    robots_.push_back(robot);
  }
  for (int g = 0; g < static_cast<int>(model.geometries.size()); ++g)
    if (const int link = contactLinks_.of(g); link >= 0) {
      const int robot = robotOf[model.geometries[g].body];
      links_[link].robot = robot;
      links_[link].isBase = robot >= 0 && model.geometries[g].body == robots_[robot].body;
    }
}

double Standing::heightOf(const Robot& robot, const Kinematics& k) const {
  const Vector3 center = k.X_WB[robot.body] * model_.bodies[robot.body].com;
  const double lowest = collision::lowestPoint(model_, k, robot.tree);
  return std::isfinite(lowest) ? center.z() - lowest : 0.0;
}

void Standing::observe(const Kinematics& kinematics,
                       const std::vector<Snapshot::ContactForce>& contacts, double time, double h) {
  if (robots_.empty()) return;
  for (Link& link : links_) link.load = 0.0, link.drift.setZero();
  for (const Snapshot::ContactForce& c : contacts) {
    const bool worldIsA = model_.geometries[c.geometryA].body == 0;
    const bool worldIsB = model_.geometries[c.geometryB].body == 0;
    if (worldIsA == worldIsB || !(c.normalForce() > 0.0)) continue;
    const int geometry = worldIsA ? c.geometryB : c.geometryA;
    Link& link = links_[contactLinks_.of(geometry)];
    if (link.robot < 0) continue;
    const Vector3 v = pointVelocity(model_, kinematics, model_.geometries[geometry].body, c.p_WC);
    link.drift += c.normalForce() * (v - v.dot(c.n_W) * c.n_W);
    link.load += c.normalForce();
  }
  for (Link& link : links_) {
    if (link.load == 0.0) continue;
    Robot& robot = robots_[link.robot];
    if (robot.firstTouch < 0.0) robot.firstTouch = time;
    if (time <= robot.firstTouch + kComesToStand) link.stands = true;
    link.lastTouch = time;
    link.slid += h / link.load * link.drift;
    if (link.stands) continue;
    if (robot.lies < 0.0 || time - robot.lastLay > kStillLies) robot.lies = time;
    robot.lastLay = time;
  }
}

std::vector<StandingOutcome> Standing::outcomes(const Kinematics& end, double time) const {
  std::vector<StandingOutcome> outcomes;
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    const Robot& robot = robots_[r];
    StandingOutcome o;
    o.base = model_.bodyNames[robot.body];
    o.cameDown = robot.height - heightOf(robot, end);
    const Vector3 up = end.X_WB[robot.body].R * robot.up_B;
    o.tilt = std::acos(std::clamp(up.dot(up_W), -1.0, 1.0));
    o.speed = -pointVelocity(model_, end, robot.body, end.X_WB[robot.body].p).dot(up_W);
    o.inAir = true;
    bool baseTouches = false, baseLies = false;
    for (std::size_t l = 0; l < links_.size(); ++l) {
      const Link& link = links_[l];
      if (link.robot != static_cast<int>(r)) continue;
      const std::string& name = contactLinks_.names()[l];
      if (link.stands && link.slid.norm() > kToldSlide)
        o.slides.push_back({name, link.slid.norm()});
      if (time - link.lastTouch > kStillTouches) continue;
      o.inAir = false;
      baseTouches = baseTouches || link.isBase;
      if (link.stands) continue;
      baseLies = baseLies || link.isBase;
      o.onGround.push_back(name);
      o.since = robot.lies;
    }
    const bool lower = o.cameDown > kFallenShare * robot.height;
    // A caster that comes to touch beside the wheels is no trunk on the ground.
    baseLies = baseLies && (o.cameDown > kSunkShare * robot.height || o.tilt > kTippedTilt);
    const bool down = lower || o.tilt > (robot.stoodOnRoot ? kTippedTilt : kFallenTilt);
    o.fell =
        (down && !o.onGround.empty()) || baseLies || (o.tilt > kLiesTilt && (baseTouches || lower));
    o.falling = down && !o.fell && !o.inAir && (o.speed > kFallSpeed || o.tilt > kLiesTilt);
    std::stable_sort(o.slides.begin(), o.slides.end(),
                     [](const auto& a, const auto& b) { return a.way > b.way; });
    outcomes.push_back(std::move(o));
  }
  return outcomes;
}

}  // namespace softgauss::app
