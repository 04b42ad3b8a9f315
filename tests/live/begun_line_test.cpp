// SPDX-License-Identifier: Apache-2.0
/// Minimum-jerk lines that go on from others.

#include "apps/live/begun_line.hpp"

#include <gtest/gtest.h>

#include "tests/support/tolerance.hpp"

namespace softgauss::live {
namespace {

/// A line that is under way.
BegunLine sample() {
  BegunLine line;
  line.p_start << 0.1, -0.2, 0.3;
  line.v_start << 0.4, 0.0, -1.1;
  line.a_start << -3.0, 2.0, 0.5;
  line.p_target << 0.5, 0.4, -0.1;
  line.startTime = 2.0;
  line.duration = 0.7;
  return line;
}

TEST(BegunLine, BeginsAsItIsToldAndEndsAtRest) {
  const BegunLine line = sample();
  const BegunLine::Point first = line.at(2.0), last = line.at(2.7);
  // Sums of a few numbers, the largest of size 100.
  constexpr double kRounding = 1e-12;
  EXPECT_SMALL((first.p - line.p_start).norm(), kRounding);
  EXPECT_SMALL((first.v - line.v_start).norm(), kRounding);
  EXPECT_SMALL((first.a - line.a_start).norm(), kRounding);
  EXPECT_SMALL((last.p - line.p_target).norm(), kRounding);
  EXPECT_SMALL(last.v.norm(), kRounding);
  EXPECT_SMALL(last.a.norm(), kRounding);
  EXPECT_SMALL((line.at(9.0).p - line.p_target).norm(), kRounding);
}

TEST(BegunLine, VelocityAndAccelerationAreTheRatesOfThePlace) {
  const BegunLine line = sample();
  constexpr double kStep = 1e-4;  // differences are wrong by its square times a few hundred
  for (double time = 2.05; time < 2.65; time += 0.05) {
    const BegunLine::Point before = line.at(time - kStep), now = line.at(time),
                           after = line.at(time + kStep);
    EXPECT_SMALL(((after.p - before.p) / (2 * kStep) - now.v).norm(), 1e-5);
    EXPECT_SMALL(((after.v - before.v) / (2 * kStep) - now.a).norm(), 1e-4);
  }
}

TEST(BegunLine, FromRestIsThatOfFlashAndHogan) {
  BegunLine line = sample();
  line.v_start.setZero();
  line.a_start.setZero();
  for (double s = 0.0; s <= 1.0; s += 0.1) {
    const double way = 10 * s * s * s - 15 * s * s * s * s + 6 * s * s * s * s * s;
    const Vector3 expected = line.p_start + way * (line.p_target - line.p_start);
    EXPECT_SMALL((line.at(2.0 + 0.7 * s).p - expected).norm(), 1e-14);
  }
}

// The line of least jerk from any of its points to its end is the rest of itself.
TEST(BegunLine, GoesOnAsItWas) {
  const BegunLine line = sample();
  BegunLine rest = line;
  rest.duration = 0.3;
  rest.startTime = 2.4;
  const BegunLine::Point at = line.at(2.4);
  rest.p_start = at.p;
  rest.v_start = at.v;
  rest.a_start = at.a;
  for (double time = 2.4; time < 2.8; time += 0.03) {
    const BegunLine::Point whole = line.at(time), part = rest.at(time);
    EXPECT_SMALL((whole.p - part.p).norm(), 1e-12);
    EXPECT_SMALL((whole.v - part.v).norm(), 1e-11);
    EXPECT_SMALL((whole.a - part.a).norm(), 1e-10);
  }
}

TEST(BegunLine, TurnsWithoutAJump) {
  BegunLine line = sample();
  const BegunLine::Point before = line.at(2.31);
  line.turnTo({-0.3, 0.2, 0.9}, 2.31);
  const BegunLine::Point after = line.at(2.31), end = line.at(2.31 + 0.7);
  EXPECT_SMALL((before.p - after.p).norm(), 1e-15);
  EXPECT_SMALL((before.v - after.v).norm(), 1e-14);
  EXPECT_SMALL((before.a - after.a).norm(), 1e-13);
  EXPECT_SMALL((end.p - Vector3(-0.3, 0.2, 0.9)).norm(), 1e-12);
}

}  // namespace
}  // namespace softgauss::live
