// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Robots on legs and on wheels for tests, and what drives them.

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "softgauss/io/simulation/simulation.hpp"

namespace softgauss::test {

// ---- A quadruped of 24 kg: hips roll and pitch, knees pitch, feet are balls ---------------------

std::string quadrupedUrdf();
extern const char* const kQuadrupedScene;  ///< it stands on bent legs

/// Feet are held or moved by goals, and the trunk with them: two feet across at a time.
class Trot {
 public:
  static constexpr double kSpeed = 0.15;       ///< along x [m/s]
  static constexpr double kFootRadius = 0.03;  ///< [m]
  inline static const Vector3 kFootInShank{0.0, 0.0, -0.25};

  /// `height` of the ground at x, y.
  Trot(Simulation& sim, std::function<double(double, double)> height);
  /// Before a step, all feet on the ground.
  void stand();
  /// Before a step, at kSpeed from `start` on.
  void walk(double start);

 private:
  struct Foot {
    gdd::Reach* goal;
    Vector3 hip;       ///< of the foot in the trunk, as it stands [m]
    Vector3 from, to;  ///< of the present swing
    bool isSwinging = false, isNew = true;
  };
  void hold(Foot& foot);
  void aimTrunk(double x);
  Vector3 groundAt(const Vector3& p) const;

  Simulation& sim_;
  std::function<double(double, double)> height_;
  gdd::Reach* trunk_;
  std::array<Foot, 4> feet_;
  double x_, y_, high_;  ///< aim of the trunk; its height over the ground [m]
};

// ---- A robot of 12 kg on four wheels ------------------------------------------------------------

inline constexpr double kWheelRadius = 0.08;
std::string roverUrdf();
extern const char* const kRoverScene;

/// Motors that follow an angle.
class Wheels {
 public:
  explicit Wheels(Simulation& sim);
  /// Before a step: all wheels at `speed` [rad/s].
  void drive(double speed);
  double angle() const;  ///< mean of the wheels [rad]
  double work = 0.0;     ///< of the motors [J]

 private:
  static constexpr double kEffort = 4.0;  ///< [N m]
  Simulation& sim_;
  std::vector<int> dofs_, places_;  ///< in v and in q
  double aim_ = 0.0;                ///< [rad]
};

}  // namespace softgauss::test
