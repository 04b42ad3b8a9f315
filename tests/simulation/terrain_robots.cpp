// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/terrain_robots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "softgauss/engine/core/index.hpp"

namespace softgauss::test {
namespace {

constexpr double kLeg = 0.25, kFoot = Trot::kFootRadius;  ///< of a thigh and of a shank; radius [m]
constexpr double kPhase = 0.3;                            ///< of two feet in the air [s]
constexpr double kLift = 0.05;                            ///< [m]
constexpr double kPress = 0.005;  ///< how far below the ground a foot seeks to stand [m]

constexpr const char* kCorners[] = {"front_left", "front_right", "hind_left", "hind_right"};

std::string inertial(double mass, const Vector3& com, const Vector3& size) {
  const Vector3 s = size.cwiseAbs2();
  return fmt::format(
      "<inertial><origin xyz=\"{} {} {}\"/><mass value=\"{}\"/><inertia ixx=\"{:.8f}\" ixy=\"0\" "
      "ixz=\"0\" iyy=\"{:.8f}\" iyz=\"0\" izz=\"{:.8f}\"/></inertial>",
      com.x(), com.y(), com.z(), mass, mass * (s.y() + s.z()) / 12, mass * (s.x() + s.z()) / 12,
      mass * (s.x() + s.y()) / 12);
}

std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const Vector3& p, const char* axis, const char* type, double effort) {
  return fmt::format(
      "<joint name=\"{}\" type=\"{}\"><parent link=\"{}\"/><child link=\"{}\"/><origin xyz=\"{} {} "
      "{}\"/><axis xyz=\"{}\"/><limit lower=\"-2.6\" upper=\"2.6\" effort=\"{}\" "
      "velocity=\"20\"/><dynamics damping=\"0.2\"/></joint>\n",
      name, type, parent, child, p.x(), p.y(), p.z(), axis, effort);
}

std::string leg(const std::string& name, double x, double y) {
  const Vector3 half(0.0, 0.0, -0.5 * kLeg), whole(0.0, 0.0, -kLeg), limb(0.04, 0.04, kLeg);
  return "<link name=\"" + name + "_hip\">" +
         inertial(0.3, Vector3::Zero(), Vector3::Constant(0.06)) + "</link>\n<link name=\"" + name +
         "_thigh\">" + inertial(0.5, half, limb) + "</link>\n<link name=\"" + name + "_shank\">" +
         inertial(0.2, half, limb) +
         fmt::format(
             "<collision><origin xyz=\"0 0 {}\"/><geometry><sphere radius=\"{}\"/>"
             "</geometry></collision></link>\n",
             -kLeg, kFoot) +
         joint(name + "_roll", "trunk", name + "_hip", {x, y, 0}, "1 0 0", "revolute", 60) +
         joint(name + "_pitch", name + "_hip", name + "_thigh", Vector3::Zero(), "0 1 0",
               "revolute", 60) +
         joint(name + "_knee", name + "_thigh", name + "_shank", whole, "0 1 0", "revolute", 60);
}

}  // namespace

std::string quadrupedUrdf() {
  std::string text =
      "<robot name=\"quadruped\">\n<link name=\"trunk\">" +
      inertial(20.0, Vector3::Zero(), {0.6, 0.3, 0.12}) +
      "<collision><geometry><sphere radius=\"0.1\"/></geometry></collision></link>\n";
  for (int i = 0; i < 4; ++i) text += leg(kCorners[i], i < 2 ? 0.3 : -0.3, i % 2 ? -0.15 : 0.15);
  return text + "</robot>\n";
}

const char* const kQuadrupedScene =
    "robots:\n"
    "  - urdf: robot.urdf\n"
    "    position: [0, 0, HIGH]\n"
    "    joints: {front_left_pitch: 0.6, front_left_knee: -1.2, front_right_pitch: 0.6,\n"
    "             front_right_knee: -1.2, hind_left_pitch: 0.6, hind_left_knee: -1.2,\n"
    "             hind_right_pitch: 0.6, hind_right_knee: -1.2}\n";

Trot::Trot(Simulation& sim, std::function<double(double, double)> height)
    : sim_(sim), height_(std::move(height)) {
  const Transform X_WT = sim.pose("trunk");
  trunk_ = &sim.goals.reach("trunk", X_WT.p, Vector3::Zero(), 2e4);
  trunk_->R_WTarget = Matrix3::Identity();
  trunk_->rotationWeight = 0.1 * trunk_->weight;
  x_ = X_WT.p.x();
  y_ = X_WT.p.y();
  high_ = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::string shank = kCorners[i] + std::string("_shank");
    const Vector3 p_LF = Trot::kFootInShank, p = sim.pose(shank) * p_LF;
    feet_[i] = {&sim.goals.reach(shank, groundAt(p), p_LF, 1e4), p - X_WT.p, {}, {}};
    high_ = std::max(high_, kFoot - feet_[i].hip.z());
  }
}

Vector3 Trot::groundAt(const Vector3& p) const {
  return {p.x(), p.y(), height_(p.x(), p.y()) + kFoot};
}

/// Over the mean of the ground under the feet.
void Trot::aimTrunk(double x) {
  double ground = 0.0;
  for (const Foot& foot : feet_)
    ground += 0.25 * height_(foot.goal->p_WTarget.x(), foot.goal->p_WTarget.y());
  trunk_->p_WTarget = Vector3(x, y_, ground + high_);
}

/// It stays where it has come down, and presses a little: a foot in the air comes down.
void Trot::hold(Foot& foot) {
  if (foot.isSwinging || foot.isNew) foot.from = sim_.pose(foot.goal->link) * foot.goal->p_FP;
  foot.isSwinging = foot.isNew = false;
  foot.goal->weight = 300.0;
  foot.goal->stiffness = 400.0;
  foot.goal->damping = 40.0;
  foot.goal->p_WTarget = groundAt(foot.from) - kPress * Vector3::UnitZ();
}

void Trot::stand() {
  for (Foot& foot : feet_) hold(foot);
  aimTrunk(trunk_->p_WTarget.x());
}

void Trot::walk(double start) {
  const double t = sim_.time() - start;
  const int phase = static_cast<int>(std::floor(t / kPhase));
  const double s = t / kPhase - phase;
  const Vector3 trunk = sim_.pose("trunk").p;
  for (std::size_t i = 0; i < 4; ++i) {
    Foot& foot = feet_[i];
    const bool isFirst = i == 0 || i == 3;
    if (isFirst != (phase % 2 == 0)) {
      hold(foot);
      continue;
    }
    if (!foot.isSwinging) foot.from = groundAt(sim_.pose(foot.goal->link) * foot.goal->p_FP);
    foot.isSwinging = true;
    foot.goal->weight = 300.0;
    foot.goal->stiffness = 1600.0;
    foot.goal->damping = 80.0;
    // Where it will be under its hip in the middle of the time that it stands.
    const Vector3 ahead((1.0 - s + 0.5) * kPhase * kSpeed, 0.0, 0.0);
    foot.to = groundAt(trunk + foot.hip + ahead);
    const double way = s * s * (3.0 - 2.0 * s);
    foot.goal->p_WTarget = foot.from + way * (foot.to - foot.from) +
                           kLift * std::pow(std::sin(M_PI * s), 2) * Vector3::UnitZ();
  }
  aimTrunk(x_ + kSpeed * t);
}

std::string roverUrdf() {
  std::string text = "<robot name=\"rover\">\n<link name=\"chassis\">" +
                     inertial(10.0, Vector3::Zero(), {0.5, 0.3, 0.1}) + "</link>\n";
  for (int i = 0; i < 4; ++i) {
    const std::string name = kCorners[i] + std::string("_wheel");
    text += "<link name=\"" + name + "\">" + inertial(0.5, Vector3::Zero(), {0.11, 0.05, 0.11}) +
            fmt::format(
                "<collision><origin rpy=\"1.57079632679 0 0\"/><geometry><cylinder "
                "radius=\"{}\" length=\"0.05\"/></geometry></collision></link>\n",
                kWheelRadius) +
            joint(name, "chassis", name, {i < 2 ? 0.2 : -0.2, i % 2 ? -0.2 : 0.2, -0.02}, "0 1 0",
                  "continuous", 4);
  }
  return text + "</robot>\n";
}

const char* const kRoverScene =
    "robots:\n"
    "  - urdf: robot.urdf\n"
    "    position: [-2, 0, HIGH]\n"
    "    rpy: [0, -0.12, 0]\n";

Wheels::Wheels(Simulation& sim) : sim_(sim) {
  sim.input().tau = VectorX::Zero(sim.model().nv);
  for (const char* corner : kCorners) {
    const int body = sim.model().findJoint(corner + std::string("_wheel"));
    dofs_.push_back(sim.model().bodies[idx(body)].v);
    places_.push_back(sim.model().bodies[idx(body)].q);
  }
}

void Wheels::drive(double speed) {
  // Four wheels stand on three: one in the air, of 0.001 kg m², has to be stable by itself.
  constexpr double kStiffness = 40.0, kDamping = 1.0;  // [N m/rad], [N m s/rad]
  const double h = sim_.model().options.timestep;
  aim_ += h * speed;
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    const double turning = sim_.state().v[dofs_[i]];
    const double torque =
        kStiffness * (aim_ - sim_.state().q[places_[i]]) + kDamping * (speed - turning);
    sim_.input().tau[dofs_[i]] = std::clamp(torque, -kEffort, kEffort);
    work += h * sim_.input().tau[dofs_[i]] * turning;
  }
}

double Wheels::angle() const {
  double sum = 0.0;
  for (const int place : places_) sum += sim_.state().q[place];
  return sum / static_cast<double>(places_.size());
}

}  // namespace softgauss::test
