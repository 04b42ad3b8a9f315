// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The scripted operator: seeks places with segments of a robot, one after the other (section VI of
/// the paper, where a person did it with the mouse).
///
/// Every kStepsPerGoal steps: a body with mass, drawn uniformly; its centre of mass, now at p, is
/// to go to
///   p* = p + σ n,   n ~ N(0, 1) per axis,   p*_z ≥ p_min
/// by ½ w |J a + J̇ v − a*|², a* = k_p (p* − p) − k_d ṗ, k_p = 100 1/s², k_d = 20 1/s (gdd::Reach).

#include <cstdint>
#include <random>
#include <vector>

#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::app {

inline constexpr int kStepsPerGoal = 500;

/// Seeded numbers, the same with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  int index(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  double normal();

 private:
  double unit() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }  // in (0, 1)
  std::mt19937_64 engine_;
};

class ScriptedOperator {
 public:
  /// deviate: σ [m]; lowest: p_min [m]; weight: w [kg].
  ScriptedOperator(const Model& model, double deviate, double lowest, double weight,
                   std::uint64_t seed);
  /// The next goal, for a robot whose bodies are where `kinematics` has them.
  gdd::Reach nextGoal(const Kinematics& kinematics);

 private:
  const Model& model_;
  double deviate_, lowest_, weight_;
  Random random_;
  std::vector<int> segments_;  ///< bodies with mass
};

}  // namespace softgauss::app
