// SPDX-License-Identifier: Apache-2.0
/// Methods that divide their steps see what touches for less than a step; the others tell.

#include <gtest/gtest.h>

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// A ball of radius 2 cm before a wall of 2 cm, on a rail.
Model ballAndWall(const Options& options) {
  ModelBuilder builder("ball");
  builder.options = options;
  builder.options.gravity.setZero();
  builder.base = BaseKind::floating;
  builder.link(sphereLink("body", 0.05, 0.02));
  builder.geometry(geometrySpec("body", Shape::sphere(0.02)));
  GeometrySpec wall = geometrySpec("world", Shape::box({0.01, 0.5, 0.5}));
  wall.X_LG.p.x() = 1.0;
  builder.geometry(wall);
  return builder.build();
}

struct Shot : Scene {
  StepStats sum;

  explicit Shot(const Options& options, double v, double x = 0.0) : Scene(ballAndWall(options)) {
    contacts = std::make_shared<collision::SceneContacts>(model);
    state.q[0] = x;
    state.v[0] = v;
  }
  void run(double duration) {
    const int count = static_cast<int>(std::lround(duration / model.options.timestep));
    for (int i = 0; i < count; ++i) {
      ASSERT_EQ(step(), SolveStatus::converged);
      sum.tunnellingSplits += data->stats.tunnellingSplits;
      sum.possibleTunnelling += data->stats.possibleTunnelling;
    }
  }
};

Options with(Integrator integrator, double h, double tolerance, bool doubling = false) {
  Options options;
  options.integrator = integrator;
  options.timestep = h;
  options.integrationTolerance = tolerance;
  options.stepDoubling = doubling;
  return options;
}

// Against steps of 40 µs, in which the fastest moves by a tenth of what it has to pass.
TEST(Sight, StepsOfEightMillisecondsSeeTheWall) {
  for (const double speed : {15.0, 20.0, 33.0, 60.0, 100.0})
    for (const double x : {0.0, 0.03, 0.07}) {
      Shot truth(with(Integrator::dormandPrince, 4e-5, 1e-10), speed, x);
      truth.run(0.16);
      for (const bool doubling : {false, true}) {
        Shot shot(doubling ? with(Integrator::semiImplicitEuler, 0.008, 1e-6, true)
                           : with(Integrator::dormandPrince, 0.008, 1e-8),
                  speed, x);
        shot.run(0.16);
        // Where the force jumps a part of h/512 is taken whatever it errs by: 16 µs of the 0.6 ms
        // that the fastest ball takes to pass. A method of order 1 errs in the other parts too.
        const double taken = x + 0.16 * speed - truth.state.q[0];  // by the wall
        EXPECT_GT(taken, 0.2);
        EXPECT_NEAR(shot.state.q[0], truth.state.q[0], taken * (doubling ? 0.1 : 0.03))
            << speed << " " << x << " " << doubling;
        EXPECT_GT(shot.sum.tunnellingSplits, 0);
        EXPECT_EQ(shot.sum.possibleTunnelling, 0);
      }
    }
}

// Pushed from rest it passes the wall within one step, of which its start tells nothing.
TEST(Sight, WhatGrowsFastWithinAStepIsSeen) {
  const auto push = [](double h, double tolerance) {
    Shot shot(with(Integrator::dormandPrince, h, tolerance), 0.0, 0.9);
    shot.input.tau[0] = 500.0;  // 10⁴ m/s²
    shot.run(0.008);
    return shot.state.q[0];
  };
  const double truth = push(2e-5, 1e-10), taken = 0.9 + 0.32 - truth;
  EXPECT_GT(taken, 0.03);
  EXPECT_NEAR(push(0.008, 1e-8), truth, 0.01 * taken);
}

TEST(Sight, AFixedStepTellsThatItMayNotSee) {
  Shot fast(with(Integrator::rungeKutta4, 0.008, 1e-6), 15.0);
  fast.run(0.16);
  EXPECT_GT(fast.sum.possibleTunnelling, 0);
  EXPECT_LE(fast.sum.possibleTunnelling, 3);  // those near the wall
  EXPECT_EQ(fast.sum.tunnellingSplits, 0);
  Shot fine(with(Integrator::rungeKutta4, 0.001, 1e-6), 15.0);
  fine.run(0.16);
  EXPECT_EQ(fine.sum.possibleTunnelling, 0);
}

TEST(Sight, SlowMotionIsNotCut) {
  for (const bool doubling : {false, true}) {
    Shot slow(doubling ? with(Integrator::semiImplicitEuler, 0.008, 1e-6, true)
                       : with(Integrator::dormandPrince, 0.008, 1e-8),
              1.0, 0.9);
    slow.run(0.16);
    EXPECT_LT(slow.state.v[0], 0.9);  // it has touched
    EXPECT_EQ(slow.sum.tunnellingSplits, 0);
  }
}

// Where nothing can touch nothing is asked.
TEST(Sight, IsNotAskedForInTheAir) {
  class Silent final : public ContactSource {
   public:
    explicit Silent(bool mayTouch) { mayTouch_ = mayTouch; }
    void detect(const Model&, const Kinematics&, ContactSet& contacts) noexcept override {
      contacts.clear();
    }
    double tunnellingTimeBound(const Model&, const Kinematics&, double longest,
                               TimeDirection) noexcept override {
      ++asked;
      return longest;
    }
    int asked = 0;
  };
  for (const bool mayTouch : {false, true}) {
    Shot shot(with(Integrator::dormandPrince, 0.008, 1e-8), 15.0);
    const auto silent = std::make_shared<Silent>(mayTouch);
    shot.contacts = silent;
    shot.run(0.08);
    EXPECT_EQ(silent->asked > 0, mayTouch);
  }
}

}  // namespace
}  // namespace softgauss::test
