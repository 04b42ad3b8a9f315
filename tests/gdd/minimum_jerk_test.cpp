// SPDX-License-Identifier: Apache-2.0
/// The minimum-jerk reach (9.3) against the line of Flash and Hogan in closed form.

#include "tests/gdd/robot_scene.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

constexpr double kDuration = 1.0;

/// r(t) = p₀ + (p* − p₀)(10 s³ − 15 s⁴ + 6 s⁵).
Vector3 lineAt(const Vector3& from, const Vector3& to, double time) {
  const double s = std::min(time / kDuration, 1.0);
  return from + (to - from) * (10 * s * s * s - 15 * s * s * s * s + 6 * s * s * s * s * s);
}

struct Tracking {
  double worst = 0.0;        ///< distance from the line [m]
  double endSpeed = 0.0;     ///< of the joints [rad/s]
  double endDistance = 0.0;  ///< from the target [m]
  double peakSpeed = 0.0;    ///< of the hand [m/s]
};

Tracking trackLine(double timestep) {
  RobotScene r("arm");
  r.model.options.timestep = timestep;
  const Vector3 from = r.position("hand"), to = from + Vector3(0.1, 0.25, -0.1);
  gdd::Reach& reach = r.addReach("hand", to);
  reach.weight = 1e8;
  reach.minimumJerk = gdd::MinimumJerk{from, 0.0, kDuration};
  // What the hand does not see is to rest as well: with R = M⁻¹ alone the elbow would sag.
  r.addDamping().weight = 1e3;
  Tracking result;
  Vector3 last = from;
  while (r.state.time < 2.5 * kDuration - 1e-9) {
    if (r.step() != SolveStatus::converged) ADD_FAILURE() << "at " << r.state.time << " s";
    const Vector3 hand = r.position("hand");
    result.worst = std::max(result.worst, (hand - lineAt(from, to, r.state.time)).norm());
    result.peakSpeed = std::max(result.peakSpeed, (hand - last).norm() / timestep);
    last = hand;
  }
  result.endSpeed = r.state.v.cwiseAbs().maxCoeff();
  result.endDistance = (last - to).norm();
  return result;
}

TEST(MinimumJerk, HandFollowsTheLineAndEndsAtRest) {
  const Tracking track = trackLine(0.002);
  // Of first order in the step: joint damping acts at its end, so that a light joint gains less
  // than the acceleration asked for. The line is 0.29 m long.
  EXPECT_SMALL(track.worst, 2e-3);
  EXPECT_SMALL(track.endDistance, 1e-5);
  // What is left is the slow sinking of motions that the hand does not see.
  EXPECT_SMALL(track.endSpeed, 2e-2);
  // 15/8 of the mean speed, the mark of a minimum-jerk motion.
  EXPECT_NEAR(track.peakSpeed, 1.875 * Vector3(0.1, 0.25, -0.1).norm() / kDuration, 0.01);
}

TEST(MinimumJerk, ErrorFallsWithTheStep) {
  const double coarse = trackLine(0.004).worst, fine = trackLine(0.001).worst;
  EXPECT_GT(coarse / fine, 2.0) << coarse << " m, " << fine << " m";
}

TEST(MinimumJerk, HoldsItsPlaceBeforeTheStart) {
  RobotScene r("arm");
  const Vector3 from = r.position("hand");
  gdd::Reach& reach = r.addReach("hand", from + Vector3(0.1, 0.2, 0.0));
  reach.weight = 1e6;
  reach.minimumJerk = gdd::MinimumJerk{from, 1.0, kDuration};
  r.addDamping();
  while (r.state.time < 0.5) r.step();
  EXPECT_SMALL((r.position("hand") - from).norm(), 1e-4);
}

}  // namespace
}  // namespace softgauss::test
