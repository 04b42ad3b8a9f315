// SPDX-License-Identifier: Apache-2.0
/// Trajectories of targets: rates are rates, integrals are least, splines are those of others.

#include "softgauss/gdd/goals/trajectory.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <memory>

#include "softgauss/engine/core/check.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

using gdd::CoordinateMotion;
using gdd::Interpolation;
using gdd::KnotTrajectory;

constexpr Interpolation kAll[] = {Interpolation::minimumJerk, Interpolation::naturalSpline,
                                  Interpolation::clampedSpline};

struct Knots {
  std::vector<double> times;
  MatrixX p;
};

/// Uneven times, three coordinates.
Knots randomKnots(Random& random, int count) {
  Knots knots{{}, MatrixX(3, count)};
  double time = random.uniform(-2.0, 2.0);
  for (int k = 0; k < count; ++k, time += random.uniform(0.5, 1.5)) {
    knots.times.push_back(time);
    knots.p.col(k) = random.vector3(1.0);
  }
  return knots;
}

/// Third and fourth derivative at a time inside of a piece, by differences of the second.
Eigen::Vector2d higherRates(const KnotTrajectory& trajectory, double time, int i) {
  constexpr double h = 1e-4;
  const double before = trajectory.at(time - h, i).a, after = trajectory.at(time + h, i).a;
  return {(after - before) / (2.0 * h),
          (after - 2.0 * trajectory.at(time, i).a + before) / (h * h)};
}

TEST(Trajectory, PassesThroughItsKnotsAndRestsBesideThem) {
  Random random(1);
  for (const Interpolation interpolation : kAll) {
    for (const int count : {1, 2, 3, 7}) {
      const Knots knots = randomKnots(random, count);
      const KnotTrajectory trajectory(knots.times, knots.p, interpolation);
      ASSERT_EQ(trajectory.size(), 3);
      for (int k = 0; k < count; ++k)
        EXPECT_APPROX(trajectory.pointAt(knots.times[static_cast<std::size_t>(k)]).p,
                      Vector3(knots.p.col(k)), 1e-14);
      for (const double time : {knots.times.front() - 0.1, knots.times.back() + 0.1}) {
        const gdd::PointMotion rest = trajectory.pointAt(time);
        EXPECT_EQ(rest.v.norm() + rest.a.norm(), 0.0);
        EXPECT_EQ(rest.p, Vector3(knots.p.col(time < knots.times.front() ? 0 : count - 1)));
        EXPECT_FALSE(trajectory.movesAt(time));
      }
      EXPECT_TRUE(trajectory.movesAt(0.5 * (knots.times.front() + knots.times.back())));
    }
  }
}

TEST(Trajectory, VelocityAndAccelerationAreTheRatesOfThePlace) {
  Random random(2);
  const Knots k = randomKnots(random, 6);
  std::vector<std::unique_ptr<gdd::Trajectory>> all;
  for (const Interpolation interpolation : kAll)
    all.push_back(std::make_unique<KnotTrajectory>(k.times, k.p, interpolation));
  all.push_back(
      std::make_unique<KnotTrajectory>(k.times, k.p, MatrixX(2.0 * k.p), MatrixX(-3.0 * k.p)));
  gdd::CircleTrajectory::Circle circle;
  circle.center = random.vector3(1.0);
  circle.normal = random.vector3(3.0);
  circle.radius = 0.7;
  circle.frequency = -0.8;
  circle.phase = 0.4;
  circle.startTime = 0.3;
  all.push_back(std::make_unique<gdd::CircleTrajectory>(circle));
  constexpr double h = 1e-4;
  for (const auto& trajectory : all)
    for (double t = k.times.front() + 0.01; t < k.times.back(); t += 0.0371)
      for (int i = 0; i < 3; ++i) {
        const CoordinateMotion now = trajectory->at(t, i);
        const CoordinateMotion before = trajectory->at(t - h, i), after = trajectory->at(t + h, i);
        // Differences are wrong by h² times higher rates of up to 1e4, and by h where a knot lies
        // between them.
        EXPECT_SMALL((after.p - before.p) / (2.0 * h) - now.v, 1e-3);
        EXPECT_SMALL((after.v - before.v) / (2.0 * h) - now.a, 0.1);
      }
}

TEST(Trajectory, TwoKnotsAreTheLineOfFlashAndHogan) {
  const MatrixX p = (MatrixX(1, 2) << 0.3, -0.5).finished();
  const KnotTrajectory line({1.0, 3.0}, p);
  for (double s = 0.0; s <= 1.0; s += 0.05) {
    const double way = 10 * s * s * s - 15 * s * s * s * s + 6 * s * s * s * s * s;
    EXPECT_SMALL(line.at(1.0 + 2.0 * s, 0).p - (0.3 - 0.8 * way), kRounding);
    const CoordinateMotion share = gdd::minimumJerkShare(1.0 + 2.0 * s, 1.0, 2.0);
    EXPECT_SMALL(share.p - way, kRounding);
    EXPECT_SMALL(line.at(1.0 + 2.0 * s, 0).v + 0.8 * share.v, kRounding);
    EXPECT_SMALL(line.at(1.0 + 2.0 * s, 0).a + 0.8 * share.a, kRounding);
  }
}

// The line of least jerk from any of its points to its end is the rest of itself.
TEST(Trajectory, ALineThatIsCutGoesOnAsItWas) {
  Random random(4);
  MatrixX p(3, 2), v(3, 2), a(3, 2);
  for (MatrixX* x : {&p, &v, &a})
    for (int k = 0; k < 2; ++k) x->col(k) = random.vector3(1.0);
  const KnotTrajectory whole({2.0, 2.7}, p, v, a);
  const gdd::PointMotion cut = whole.pointAt(2.4);
  p.col(0) = cut.p, v.col(0) = cut.v, a.col(0) = cut.a;
  const KnotTrajectory rest({2.4, 2.7}, p, v, a);
  for (double time = 2.4; time < 2.7; time += 0.03) {
    EXPECT_SMALL((whole.pointAt(time).p - rest.pointAt(time).p).norm(), 1e-13);
    EXPECT_SMALL((whole.pointAt(time).v - rest.pointAt(time).v).norm(), 1e-12);
    EXPECT_SMALL((whole.pointAt(time).a - rest.pointAt(time).a).norm(), 1e-11);
  }
}

// Euler and Lagrange: through via points the integral of the squared jerk is least where the rates
// up to the fourth go on, and the sixth is 0, as it is of a quintic.
TEST(Trajectory, MinimumJerkIsSmoothThroughViaPoints) {
  Random random(5);
  const Knots k = randomKnots(random, 8);
  const KnotTrajectory trajectory(k.times, k.p);
  for (const double end : {k.times.front(), k.times.back()})
    EXPECT_SMALL(trajectory.pointAt(end).v.norm() + trajectory.pointAt(end).a.norm(), 1e-13);
  Eigen::Vector2d jump(0.0, 0.0), most(0.0, 0.0);
  for (std::size_t knot = 1; knot + 1 < k.times.size(); ++knot)
    for (int i = 0; i < 3; ++i) {
      // Away from the knot by 2e-4 s on both sides: the third rate changes by the fourth times
      // that.
      const Eigen::Vector2d before = higherRates(trajectory, k.times[knot] - 2e-4, i);
      const Eigen::Vector2d after = higherRates(trajectory, k.times[knot] + 2e-4, i);
      const Eigen::Vector2d change(2e-4 * (after[1] + before[1]), 0.0);
      jump = jump.cwiseMax((after - before - change).cwiseAbs());
      most = most.cwiseMax(before.cwiseAbs());
    }
  // The fifth rate jumps: by some ten times the fourth, over 4e-4 s.
  EXPECT_LT(jump[0], 1e-4 * most[0]);
  EXPECT_LT(jump[1], 1e-2 * most[1]);
}

// An independent way to a cubic spline: its second rates m at the knots solve
//   h₋ m₋ + 2 (h₋ + h) m + h m₊ = 6 (Δ/h − Δ₋/h₋).
TEST(Trajectory, NaturalSplineHasTheSecondRatesOfTheTextbook) {
  Random random(6);
  const Knots k = randomKnots(random, 9);
  const KnotTrajectory spline(k.times, k.p, Interpolation::naturalSpline);
  const Eigen::Index n = 9;
  MatrixX A = MatrixX::Identity(n, n);
  MatrixX b = MatrixX::Zero(n, 3);
  const auto h = [&](Eigen::Index i) {
    return k.times[static_cast<std::size_t>(i + 1)] - k.times[static_cast<std::size_t>(i)];
  };
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    A(i, i - 1) = h(i - 1);
    A(i, i) = 2.0 * (h(i - 1) + h(i));
    A(i, i + 1) = h(i);
    b.row(i) =
        6.0 * ((k.p.col(i + 1) - k.p.col(i)) / h(i) - (k.p.col(i) - k.p.col(i - 1)) / h(i - 1))
                  .transpose();
  }
  const MatrixX m = A.partialPivLu().solve(b);
  for (Eigen::Index i = 0; i < n; ++i)
    EXPECT_APPROX(spline.pointAt(k.times[static_cast<std::size_t>(i)]).a,
                  Vector3(m.row(i).transpose()), 1e-11);
}

// What is a spline already comes back: a line by the natural one, a cubic that rests at both ends
// by the clamped one.
TEST(Trajectory, SplinesGiveBackWhatTheyAre) {
  Random random(7);
  const Knots k = randomKnots(random, 7);
  const double t0 = k.times.front(), T = k.times.back() - t0;
  MatrixX line(1, 7), cubic(1, 7);
  const auto way = [&](double t) { return (t - t0) / T; };
  const auto rest = [&](double t) { return way(t) * way(t) * (3.0 - 2.0 * way(t)); };
  for (int i = 0; i < 7; ++i) {
    line(0, i) = way(k.times[static_cast<std::size_t>(i)]);
    cubic(0, i) = rest(k.times[static_cast<std::size_t>(i)]);
  }
  const KnotTrajectory natural(k.times, line, Interpolation::naturalSpline);
  const KnotTrajectory clamped(k.times, cubic, Interpolation::clampedSpline);
  for (double t = t0; t < t0 + T; t += 0.05) {
    EXPECT_SMALL(natural.at(t, 0).p - way(t), kRounding);
    EXPECT_SMALL(natural.at(t, 0).v - 1.0 / T, kRounding);
    EXPECT_SMALL(clamped.at(t, 0).p - rest(t), kRounding);
    EXPECT_SMALL(clamped.at(t, 0).a - (6.0 - 12.0 * way(t)) / (T * T), 1e-12);
  }
}

TEST(Trajectory, ACircleKeepsItsRadiusAndItsPlane) {
  gdd::CircleTrajectory::Circle circle;
  circle.center = Vector3(0.5, 0.1, 0.4);
  circle.radius = 0.1;
  circle.frequency = 0.5;
  const gdd::CircleTrajectory flat(circle);
  EXPECT_APPROX(flat.pointAt(0.0).p, Vector3(0.6, 0.1, 0.4), kUnitRounding);
  EXPECT_APPROX(flat.pointAt(0.5).p, Vector3(0.5, 0.2, 0.4), kUnitRounding);
  EXPECT_APPROX(flat.pointAt(2.0).p, flat.pointAt(0.0).p, kUnitRounding);
  Random random(8);
  for (const Vector3& n : {Vector3(1.0, 0.0, 0.0), Vector3(-3.0, 1e-5, 0.0), random.vector3(5.0)}) {
    circle.normal = n;
    const gdd::CircleTrajectory turned(circle);
    for (double t = 0.0; t < 2.0; t += 0.13) {
      const gdd::PointMotion r = turned.pointAt(t);
      EXPECT_SMALL((r.p - circle.center).norm() - 0.1, kUnitRounding);
      EXPECT_SMALL((r.p - circle.center).dot(n.normalized()), kUnitRounding);
      EXPECT_SMALL(r.v.norm() - 0.1 * M_PI, kUnitRounding);
      EXPECT_GT(n.dot((r.p - circle.center).cross(r.v)), 0.0) << "counterclockwise about n";
    }
  }
}

TEST(Trajectory, RefusesWhatHasNoTimeOrNoNumbers) {
  const MatrixX two = MatrixX::Zero(3, 2);
  EXPECT_THROW(KnotTrajectory({0.0}, two), ModelError);
  EXPECT_THROW(KnotTrajectory({}, MatrixX(3, 0)), ModelError);
  EXPECT_THROW(KnotTrajectory({1.0, 1.0}, two), ModelError);
  EXPECT_THROW(KnotTrajectory({1.0, kNaN}, two), ModelError);
  EXPECT_THROW(KnotTrajectory({0.0, 1.0}, MatrixX::Constant(3, 2, kInfinity)), ModelError);
  EXPECT_THROW(KnotTrajectory({0.0, 1.0}, two, two, MatrixX::Zero(2, 2)), ModelError);
  gdd::CircleTrajectory::Circle circle;
  circle.normal.setZero();
  EXPECT_THROW(gdd::CircleTrajectory{circle}, ModelError);
  circle.normal = Vector3(0.0, kNaN, 1.0);
  EXPECT_THROW(gdd::CircleTrajectory{circle}, ModelError);
}

}  // namespace
}  // namespace softgauss::test
