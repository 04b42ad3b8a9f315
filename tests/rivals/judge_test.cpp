// SPDX-License-Identifier: Apache-2.0
/// The judge of the study beside other engines, on motions that are known in closed form: it finds
/// no error in them, and finds the error that was put in.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "apps/rivals/judge/measures.hpp"
#include "apps/rivals/judge/overlap.hpp"

namespace rivals {
namespace {

constexpr double kGravity = 9.81;

Body cube(double half = 0.1) {
  return {"cube",
          1.0,
          Vector3d::Constant(2.0 / 3.0 * half * half),
          {Vector3d(0, 0, half), Quaterniond::Identity(), Vector3d::Zero(), Vector3d::Zero()},
          {{ShapeKind::box, Vector3d::Constant(half)}}};
}

Scene sceneOf(const std::string& measure, const Body& body, double duration = 1.0) {
  return {"scene", measure, Vector3d(0, 0, -kGravity), 0.5, true, true, duration, 0.01, {body}, {}};
}

/// Samples of a motion of the first body.
Trajectory sampled(const Scene& scene, const std::function<void(double, BodyState&)>& move) {
  Trajectory run;
  const int samples = static_cast<int>(std::lround(scene.duration / scene.sample));
  for (int k = 0; k <= samples; ++k) {
    std::vector<BodyState> states;
    for (const Body& b : scene.bodies) states.push_back(b.start);
    move(k * scene.sample, states.front());
    run.push_back(states);
  }
  return run;
}

TEST(RivalsJudge, KnowsWhereAThrownBoxStops) {
  Body body = cube();
  const Vector3d along = Vector3d(3, 4, 0).normalized();
  body.start.velocity = 2.0 * along;
  const Scene scene = sceneOf("thrown", body);
  const double slow = 0.5 * kGravity, until = 2.0 / slow;
  const auto coulomb = [&](double further, const Vector3d& aside) {
    return sampled(scene, [&, further](double t, BodyState& s) {
      const double u = std::min(t, until);
      s.position += (2.0 * u - 0.5 * slow * u * u) * (1.0 + further) * along + t * aside;
      s.velocity = (2.0 - slow * u) * along;
    });
  };
  Measures m = measure(scene, coulomb(0.0, Vector3d::Zero()));
  EXPECT_NEAR(m.at("truth_mm"), 407.747, 1e-3);
  EXPECT_NEAR(m.at("off_mm"), 0.0, 1e-9);
  EXPECT_NEAR(m.at("aside_mm"), 0.0, 1e-9);
  // Too far by 38 %, and 67 mm aside: both are found, each where it belongs.
  m = measure(scene, coulomb(0.38, 0.067 * Vector3d(-4, 3, 0).normalized()));
  EXPECT_NEAR(m.at("off_percent"), 38.0, 1e-9);
  EXPECT_NEAR(m.at("aside_mm"), 67.0, 1e-9);
}

TEST(RivalsJudge, KnowsHowABoxSlidesAndCreeps) {
  Scene scene = sceneOf("slides", cube());
  const double slope = 37.0 * std::numbers::pi / 180.0;
  scene.gravity = kGravity * Vector3d(std::sin(slope), 0, -std::cos(slope));
  const double a = kGravity * (std::sin(slope) - 0.5 * std::cos(slope));
  const auto slide = [&](double factor) {
    return sampled(scene,
                   [&](double t, BodyState& s) { s.position[0] += factor * 0.5 * a * t * t; });
  };
  EXPECT_NEAR(measure(scene, slide(1.0)).at("off_mm"), 0.0, 1e-9);
  EXPECT_NEAR(measure(scene, slide(1.01)).at("off_mm"), 5.0 * a, 1e-9);
  scene.measure = "creep";
  const Trajectory creeping =
      sampled(scene, [](double t, BodyState& s) { s.position += t * Vector3d(1.3e-3, 2e-4, 0); });
  EXPECT_NEAR(measure(scene, creeping).at("creep_mm_s"), 1.3, 1e-9);
  EXPECT_NEAR(measure(scene, creeping).at("aside_mm_s"), 0.2, 1e-9);
}

TEST(RivalsJudge, KnowsARollingBall) {
  Body ball = cube();
  ball.shapes = {{ShapeKind::sphere, Vector3d(0.1, 0, 0)}};
  ball.start.velocity = Vector3d(2, 0, 0);
  Scene scene = sceneOf("rolling", ball);
  scene.friction = 0.3;
  // Closed form integrated by hand: v falls by μ g until it is R ω, which rises by 5 μ g/2.
  const double rub = 0.3 * kGravity, until = 4.0 / 7.0 / rub;
  const auto roll = [&](double spin) {
    return sampled(scene, [&, spin](double t, BodyState& s) {
      const double u = std::min(t, until), v = 2.0 - rub * u;
      s.position[0] += 2.0 * u - 0.5 * rub * u * u + (t - u) * v;
      s.velocity = Vector3d(v, 0, 0);
      s.angularVelocity = Vector3d(0, spin * 2.5 * rub * u / 0.1, 0);
    });
  };
  EXPECT_NEAR(measure(scene, roll(1.0)).at("off_mm"), 0.0, 1e-9);
  EXPECT_NEAR(measure(scene, roll(1.0)).at("slip_percent"), 0.0, 1e-9);
  EXPECT_NEAR(measure(scene, roll(0.9)).at("slip_percent"), 10.0, 1e-9);
}

// SimBenchmark's rolling by hand: 150 N on 10 kg under 25 kg of balls, friction 0.4 below; what
// rolls on an accelerated ground takes 2/7 of it. A velocity that is off by 0.1 m/s in either is
// 0.01.
TEST(RivalsJudge, KnowsWhatIsPushedAndWhatRollsOnIt) {
  Body box = cube(), ball = cube();
  box.mass = 10.0, ball.mass = 25.0;
  box.force = Vector3d(90, 120, 0);
  Scene scene = sceneOf("pushed", box);
  scene.bodies.push_back(ball);
  scene.friction = 0.8, scene.groundFriction = 0.4;
  const double a = (150.0 - 0.4 * 35.0 * kGravity) / (10.0 + 50.0 / 7.0);
  const auto roll = [&](double boxOff, double ballOff) {
    Trajectory run = sampled(scene, [](double, BodyState&) {});
    for (std::size_t k = 0; k < run.size(); ++k) {
      const double t = static_cast<double>(k) * scene.sample;
      run[k][0].velocity = t * a * Vector3d(0.6, 0.8, 0) + Vector3d(0, 0, boxOff);
      run[k][1].velocity = 2.0 / 7.0 * t * a * Vector3d(0.6, 0.8, 0) + Vector3d(ballOff, 0, 0);
    }
    return measure(scene, run).at("velocity_error_m2_s2");
  };
  EXPECT_NEAR(roll(0.0, 0.0), 0.0, 1e-12);
  EXPECT_NEAR(roll(0.1, 0.0), 0.01, 1e-12);
  EXPECT_NEAR(roll(0.1, 0.1), 0.02, 1e-12);
}

// A ball that falls keeps its energy; one that is 1 m/s too fast at the height where it rests has
// half a joule a kilogram too much.
TEST(RivalsJudge, KnowsWhatKeepsItsEnergy) {
  const Scene scene = sceneOf("elastic", cube());
  const auto move = [&](double pull, double fast) {
    return measure(scene, sampled(scene,
                                  [&, pull, fast](double t, BodyState& s) {
                                    s.position += 0.5 * pull * t * t * scene.gravity;
                                    s.velocity = pull * t * scene.gravity + Vector3d(fast, 0, 0);
                                  }))
        .at("energy_error_J2");
  };
  EXPECT_NEAR(move(1.0, 0.0), 0.0, 1e-12);
  EXPECT_NEAR(move(0.0, 1.0), 0.25, 1e-12);
}

TEST(RivalsJudge, KnowsAFreeFlight) {
  Body body = cube();
  body.inertia = Vector3d(0.02, 0.02, 0.01);  // about z it turns steadily
  body.start.velocity = Vector3d(1, 0, 2);
  body.start.angularVelocity = Vector3d(0, 0, 5);
  const Scene scene = sceneOf("free", body);
  const auto fly = [&](double pull, double spin) {
    return sampled(scene, [&, pull, spin](double t, BodyState& s) {
      s.position += t * s.velocity + 0.5 * pull * t * t * scene.gravity;
      s.velocity += pull * t * scene.gravity;
      s.orientation = Eigen::AngleAxisd(5.0 * t, Vector3d::UnitZ());
      s.angularVelocity[2] *= 1.0 + spin * t;
    });
  };
  Measures m = measure(scene, fly(1.0, 0.0));
  EXPECT_NEAR(m.at("parabola_mm"), 0.0, 1e-9);
  EXPECT_NEAR(m.at("energy_percent"), 0.0, 1e-9);
  EXPECT_NEAR(m.at("momentum"), 0.0, 1e-12);
  EXPECT_NEAR(measure(scene, fly(1.0, 0.1)).at("momentum"), 0.1, 1e-12);
  m = measure(scene, fly(1.001, 0.0));
  EXPECT_NEAR(m.at("parabola_mm"), 0.5e-3 * kGravity * 1e3, 1e-6);
  EXPECT_GT(m.at("energy_percent"), 0.01);
}

TEST(RivalsJudge, KnowsBetweenWhichAnglesATopNods) {
  Body top = cube();
  const Quaterniond R(Eigen::AngleAxisd(20.0 * std::numbers::pi / 180.0, Vector3d::UnitX()));
  top.inertia = Vector3d(0.0012, 0.0012, 0.002);
  top.start.orientation = R;
  top.start.position = R * Vector3d(0, 0, 0.1);
  top.start.angularVelocity = R * Vector3d(0, 0, 100);
  Scene scene = sceneOf("top", top);
  scene.joints = {{JointKind::ball, -1, 0, Vector3d::Zero(), Vector3d::UnitZ(), {}, 0.0}};
  const auto [low, high] = tiltOfTop(scene);
  EXPECT_NEAR(low * 180.0 / std::numbers::pi, 20.0, 1e-3);  // released at its highest point
  // Of a top released at u₀ with spin alone: a²/β (1 − u²)⁻¹… by (1 − u²) β = a² (u₀ − u).
  const double u0 = std::cos(low), u = std::cos(high), across = 0.0012 + 0.01;
  const double a = 0.002 * 100 / across, beta = 2.0 * kGravity * 0.1 / across;
  EXPECT_NEAR((1.0 - u * u) * beta, a * a * (u0 - u), 1e-6 * a * a);
  // A top that does not nod is not right.
  EXPECT_GT(measure(scene, sampled(scene, [](double, BodyState&) {})).at("tilt_error_deg"), 30.0);
}

TEST(RivalsJudge, KnowsWhatAreTowerGripAndDrop) {
  Body body = cube();
  Scene scene = sceneOf("tower", body);
  const auto sink = [&](double speed) {
    return sampled(scene, [speed](double t, BodyState& s) {
      s.position += Vector3d(0.002 * t, 0, -speed * t);
      s.orientation = Eigen::AngleAxisd(0.1 * t, Vector3d::UnitX());
    });
  };
  Measures m = measure(scene, sink(0.003));
  EXPECT_NEAR(m.at("sinks_mm"), 3.0, 1e-9);
  EXPECT_NEAR(m.at("drift_mm"), 2.0, 1e-9);
  EXPECT_NEAR(m.at("leans_deg"), 0.1 * 180.0 / std::numbers::pi, 1e-6);
  scene.measure = "grip";
  EXPECT_NEAR(measure(scene, sink(0.003)).at("creep_um_s"), 3000.0, 1e-6);
  EXPECT_EQ(measure(scene, sink(0.003)).at("lost_s"), -1.0);
  EXPECT_NEAR(measure(scene, sink(0.1)).at("lost_s"), 0.51, 1e-9);  // after 50 mm
  scene.measure = "drop";
  scene.bodies[0].shapes = {{ShapeKind::sphere, Vector3d(0.1, 0, 0)}};
  m = measure(scene, sampled(scene, [](double t, BodyState& s) {
                s.position[2] += 0.02 - 0.05 * std::sin(std::numbers::pi * t);
              }));
  EXPECT_NEAR(m.at("deepest_mm"), 30.0, 1e-9);
  EXPECT_NEAR(m.at("rebound_mm"), 20.0, 1e-9);
}

TEST(RivalsJudge, FindsGapsOfARope) {
  Scene scene = sceneOf("rope", cube());
  scene.joints = {{JointKind::tie, -1, 0, Vector3d(0.1, 0.1, 0.2), Vector3d::UnitZ(), {}, 0.0}};
  const double angle =
      0.01;  // turned about its centre: the corner moves by 2 sin(angle/2) times its arm
  const Trajectory run = sampled(scene, [&](double, BodyState& s) {
    s.orientation = Eigen::AngleAxisd(angle, Vector3d::UnitZ());
  });
  EXPECT_NEAR(measure(scene, run).at("gap_mm"),
              1e3 * 2.0 * std::sin(angle / 2.0) * 0.1 * std::numbers::sqrt2, 1e-6);
}

TEST(RivalsJudge, FindsOverlaps) {
  const auto at = [](double x, double y, double z) {
    return Isometry3d(Eigen::Translation3d(x, y, z));
  };
  const Shape box{ShapeKind::box, Vector3d(0.1, 0.2, 0.3)},
      ball{ShapeKind::sphere, Vector3d(0.1, 0, 0)},
      capsule{ShapeKind::capsule, Vector3d(0.05, 0.2, 0)};
  EXPECT_NEAR(distanceOf(box, at(0, 0, 0), box, at(0.19, 0, 0)), -0.01, 1e-12);
  EXPECT_NEAR(distanceOf(box, at(0, 0, 0), ball, at(0, 0.35, 0)), 0.05, 1e-12);
  EXPECT_NEAR(distanceOf(ball, at(0, 0, 0.35), box, at(0, 0, 0)), -0.05, 1e-12);
  EXPECT_NEAR(distanceOf(ball, at(0, 0, 0), ball, at(0, 0.1, 0)), -0.1, 1e-12);
  EXPECT_NEAR(distanceOf(capsule, at(0, 0, 0), capsule, at(0.09, 0, 0.1)), -0.01, 1e-12);
  const Isometry3d across =
      at(0, 0.08, 0.1) * Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitY());
  EXPECT_NEAR(distanceOf(capsule, at(0, 0, 0), capsule, across), -0.02, 1e-12);
  EXPECT_NEAR(distanceOf(capsule, at(0.14, 0, 0), box, at(0, 0, 0)), -0.01, 1e-9);
  EXPECT_NEAR(lowestPoint(capsule, at(0, 0, 0.2)), -0.05, 1e-12);
  Scene scene = sceneOf("pile", cube());
  scene.bodies.push_back(cube());
  scene.bodies[1].start.position = Vector3d(0, 0, 0.295);
  EXPECT_NEAR(deepestOverlap(scene, {scene.bodies[0].start, scene.bodies[1].start}), 0.005, 1e-12);
  EXPECT_NEAR(measure(scene, sampled(scene, [](double, BodyState& s) { s.position[2] -= 0.02; }))
                  .at("rest_mm"),
              20.0, 1e-9);
}

TEST(RivalsJudge, TellsRunsApart) {
  const Scene scene = sceneOf("smooth", cube());
  const Trajectory still = sampled(scene, [](double, BodyState&) {});
  const Trajectory moved =
      sampled(scene, [](double t, BodyState& s) { s.position[0] += t > 0.0 ? 0.01 : 0.0; });
  const Trajectory turned = sampled(scene, [](double t, BodyState& s) {
    if (t > 0.0) s.orientation = Eigen::AngleAxisd(0.1, Vector3d::UnitZ());
  });
  EXPECT_NEAR(distanceOf(scene, moved, still), 0.01, 1e-15);
  EXPECT_NEAR(distanceOf(scene, turned, still), 0.1 * std::sqrt(0.01),
              1e-9);  // half the trace over the mass
  EXPECT_TRUE(std::isnan(distanceOf(scene, Trajectory(still.begin(), still.end() - 1), still)));
  EXPECT_NEAR(
      startError(scene, sampled(scene, [](double, BodyState& s) { s.angularVelocity[1] = 1e-3; })),
      1e-3, 1e-15);
  EXPECT_THROW(measure(sceneOf("beauty", cube()), still), std::invalid_argument);
}

// A body that swings about the origin with one that slips along it by 3 mm.
TEST(RivalsJudge, KnowsWhatSlipsInAGrip) {
  Scene scene = sceneOf("carried", cube());
  scene.bodies.push_back(cube());
  for (const double slip : {0.0, 3e-3}) {
    Trajectory run = sampled(scene, [](double, BodyState&) {});
    for (std::size_t k = 0; k < run.size(); ++k) {
      const double t = static_cast<double>(k) * scene.sample;
      const Quaterniond turn(Eigen::AngleAxisd(3.0 * t, Vector3d::UnitY()));
      for (BodyState& s : run[k]) s.orientation = turn, s.position = turn * Vector3d(0, 0, -1);
      run[k].back().position += turn * Vector3d(slip * t, 0, 0);
    }
    const Measures m = measure(scene, run);
    EXPECT_NEAR(m.at("slipped_mm"), 1e3 * slip, 1e-9);
    EXPECT_NEAR(m.at("turned_deg"), 0.0, 1e-5);
    EXPECT_EQ(m.at("lost"), 0.0);
  }
}

// One wheel, a ball of 1 kg under a block of 1 kg: v₀ 2/(2 + 0.4) is left when it rolls.
TEST(RivalsJudge, KnowsHowFarACartRolls) {
  Body body = cube();
  body.start.velocity = Vector3d(0.6, 0.8, 0);
  Scene scene = sceneOf("cart", body, 10.0);
  Body wheel = cube();
  wheel.inertia = Vector3d::Constant(0.4 * 0.05 * 0.05);
  wheel.shapes = {{ShapeKind::sphere, Vector3d(0.05, 0, 0)}};
  scene.bodies.push_back(wheel);
  const double rolls = 2.0 / 2.4, slides = (1.0 - rolls) / (0.5 * kGravity);
  const Vector3d across(-0.8, 0.6, 0);
  const Measures m = measure(scene, sampled(scene, [&](double t, BodyState& s) {
                               const double u = std::min(t, slides);
                               const double way = u - 0.25 * kGravity * u * u + rolls * (t - u);
                               s.position += (way - 1e-3 * t) * s.velocity + 1e-3 * t * across;
                             }));
  EXPECT_NEAR(m.at("truth_mm"), 1e3 * (rolls * 10.0 + 0.5 * slides * (1.0 - rolls)), 1e-6);
  EXPECT_NEAR(m.at("off_mm"), -10.0, 1e-6);
  EXPECT_NEAR(m.at("aside_mm"), 10.0, 1e-6);
}

// The wall beside it stands 1 mm in it.
TEST(RivalsJudge, KnowsWhetherAPegStandsOnTheGround) {
  Scene scene = sceneOf("peg", cube());
  scene.bodies.push_back(cube());
  scene.bodies.front().start.position[0] = 0.199;
  Trajectory run = sampled(scene, [](double, BodyState&) {});
  const double tilt = 0.01;
  run.back().back().position[2] += 2e-3;
  run.back().back().orientation = Eigen::AngleAxisd(tilt, Vector3d::UnitX());
  const Measures m = measure(scene, run);
  EXPECT_NEAR(m.at("left_mm"), 2.0, 1e-9);
  EXPECT_NEAR(m.at("leans_deg"), tilt * 180.0 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(m.at("overlap_mm"), 1.0, 1e-9);
}

}  // namespace
}  // namespace rivals
