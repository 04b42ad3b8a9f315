// SPDX-License-Identifier: Apache-2.0
/// The judge of the study on what bounces, screws and walks: closed forms go in, and what differs
/// from them is found.

#include "apps/rivals/judge/machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace rivals::machines {
namespace {

constexpr double kGravity = 9.81;

Body bodyWith(const Shape& shape, double mass = 1.0) {
  return {"body",
          mass,
          Vector3d::Constant(0.004 * mass),
          {Vector3d::Zero(), Quaterniond::Identity(), Vector3d::Zero(), Vector3d::Zero()},
          {shape}};
}

Scene sceneOf(const std::string& measure, std::vector<Body> bodies, double duration,
              double sample) {
  return {measure,  measure, Vector3d(0, 0, -kGravity), 0.5, true, true,
          duration, sample,  std::move(bodies),         {}};
}

/// Samples of a motion of the last body.
Trajectory sampled(const Scene& scene, const std::function<void(double, BodyState&)>& move) {
  Trajectory run;
  for (int k = 0; k <= std::lround(scene.duration / scene.sample); ++k) {
    std::vector<BodyState> states;
    for (const Body& b : scene.bodies) states.push_back(b.start);
    move(k * scene.sample, states.back());
    run.push_back(states);
  }
  return run;
}

// ---- Bounces ------------------------------------------------------------------------------------

/// Height and speed of a point that falls from `fall` and leaves each impact with e times its
/// speed.
std::pair<double, double> bouncing(double fall, double e, double time) {
  double speed = std::sqrt(2.0 * kGravity * fall), from = speed / kGravity;
  if (time < from) return {fall - 0.5 * kGravity * time * time, -kGravity * time};
  if (time >= from * (1.0 + e) / (1.0 - e)) return {0.0, 0.0};  // after bounces without number
  for (speed *= e; time >= from + 2.0 * speed / kGravity; speed *= e)
    from += 2.0 * speed / kGravity;
  const double t = time - from;
  return {speed * t - 0.5 * kGravity * t * t, speed - kGravity * t};
}

TEST(RivalsJudge, KnowsHowHighABallBounces) {
  Body ball = bodyWith({ShapeKind::sphere, Vector3d(0.1, 0, 0)});
  ball.start.position[2] = 1.1;
  Scene scene = sceneOf("bounce", {ball}, 3.0, 0.002);
  scene.restitution = 0.8;
  EXPECT_NEAR(scene.fallSpeed(), std::sqrt(2.0 * kGravity), 1e-12);
  const auto run = [&](double e, double sunk) {
    return sampled(scene, [&, e, sunk](double t, BodyState& s) {
      const auto [height, speed] = bouncing(1.0, e, t);
      s.position[2] = 0.1 + height - sunk;
      s.velocity[2] = speed;
    });
  };
  // A sample misses a top by half its length at most: ½ g (1 ms)², 5 µm.
  Measures m = measure(scene, run(0.8, 0.0));
  EXPECT_NEAR(m.at("top1_mm"), 640.0, 0.005);
  EXPECT_NEAR(m.at("top2_mm"), 409.6, 0.005);
  EXPECT_NEAR(m.at("top3_mm"), 262.144, 0.005);
  EXPECT_NEAR(m.at("off_percent"), 0.0, 5e-4);
  // Of 0.7 in place of 0.8 the second height is the worst: 0.2401 for 0.4096.
  m = measure(scene, run(0.7, 0.0));
  EXPECT_NEAR(m.at("off_percent"), 16.95, 1e-3);
  EXPECT_GE(measure(scene, run(0.8, 0.02)).at("deepest_mm"), 19.0);
  // A turn counts before the fourth impact, at 0.45 + 2 · 0.45 (0.8 + 0.64 + 0.512) = 2.21 s.
  const auto turning = [&](double from) {
    Trajectory made = run(0.8, 0.0);
    for (std::size_t k = 0; k < made.size(); ++k)
      if (static_cast<double>(k) * scene.sample > from)
        made[k][0].orientation = Eigen::AngleAxisd(0.1, Vector3d::UnitX());
    return measure(scene, made).at("turned_deg");
  };
  EXPECT_NEAR(turning(2.1), 0.1 * 180.0 / std::numbers::pi, 1e-9);
  EXPECT_EQ(turning(2.3), 0.0);
  // What does not come up has bounced to 0.
  m = measure(scene, sampled(scene, [](double, BodyState&) {}));
  EXPECT_NEAR(m.at("off_percent"), 64.0, 1e-9);
}

// ---- A nut --------------------------------------------------------------------------------------

/// A ball that runs at 50 mm on a plate with a slope of 0.2.
Scene screw(double friction) {
  Body post = bodyWith({ShapeKind::box, Vector3d(0.01, 0.01, 0.01)});
  post.shapes[0].pose.linear() =
      Eigen::AngleAxisd(std::atan(0.2), Vector3d::UnitX()).toRotationMatrix();
  Body nut = bodyWith({ShapeKind::sphere, Vector3d(0.005, 0, 0)}, 2.0);
  nut.shapes[0].pose.translation() = Vector3d(0.03, 0.04, 0);
  nut.inertia = Vector3d(0.005, 0.005, 0.01);
  Scene scene = sceneOf("nut", {post, nut}, 1.0, 0.01);
  scene.friction = friction;
  return scene;
}

TEST(RivalsJudge, KnowsWhatANutSinks) {
  EXPECT_EQ(sinkOfNut(screw(0.2), 1.0), 0.0);
  EXPECT_EQ(sinkOfNut(screw(0.4), 1.0), 0.0);
  // Without friction what it falls is in its motion: m g z = ½ m v² + ½ I (v/(r tan λ))².
  const double m = 2.0, I = 0.01, c = 0.05 * 0.2;
  const double fallen = sinkOfNut(screw(0.0), 1.0), v = 2.0 * fallen;
  EXPECT_NEAR(m * kGravity * fallen, 0.5 * m * v * v + 0.5 * I * v * v / (c * c), 1e-9);
  // With friction what is missing is μ N times the way along the thread, of N from m a = m g − …
  const double mu = 0.1, sunk = sinkOfNut(screw(mu), 1.0), w = 2.0 * sunk;
  const double sine = 0.2 / std::sqrt(1.04), cosine = 1.0 / std::sqrt(1.04);
  const double N = m * (kGravity - w) / (cosine + mu * sine);
  const double missing = m * kGravity * sunk - 0.5 * m * w * w - 0.5 * I * w * w / (c * c);
  EXPECT_NEAR(missing, mu * N * sunk / sine, 1e-9);
}

TEST(RivalsJudge, FollowsANutDownItsThread) {
  const Scene scene = screw(0.1);
  const double a = 2.0 * sinkOfNut(scene, 1.0);
  const auto run = [&](double stretch, double aside) {
    return sampled(scene, [&, stretch, aside](double t, BodyState& s) {
      const double z = 0.5 * a * t * t;
      s.position += Vector3d(aside * t, 0, -stretch * z);
      s.orientation = Eigen::AngleAxisd(-z / 0.01, Vector3d::UnitZ());
    });
  };
  Measures m = measure(scene, run(1.0, 0.0));
  EXPECT_NEAR(m.at("off_mm"), 0.0, 1e-9);
  EXPECT_NEAR(m.at("off_thread_mm"), 0.0, 1e-9);
  EXPECT_NEAR(m.at("turned_deg"), -0.5 * a / 0.01 * 180.0 / std::numbers::pi, 1e-6);
  m = measure(scene, run(1.1, 2e-3));
  EXPECT_NEAR(m.at("off_mm"), 0.1 * m.at("truth_mm"), 1e-9);
  EXPECT_NEAR(m.at("off_thread_mm"), 0.1 * m.at("truth_mm"), 1e-9);
  EXPECT_NEAR(m.at("aside_mm"), 2.0, 1e-9);
}

// ---- Feet ---------------------------------------------------------------------------------------

/// 4 kg, 1 kg and 5 kg: each frame is lifted once for 0.6 s, and swings by 4 m/s² for 0.1 s to and
/// 0.1 s fro.
Scene walker() {
  const Shape sole{ShapeKind::box, Vector3d(0.1, 0.1, 0.01)};
  Scene scene =
      sceneOf("feet", {bodyWith(sole, 4.0), bodyWith(sole, 1.0), bodyWith(sole, 5.0)}, 2.0, 0.02);
  const Vector3d along(0.6, 0.8, 0);
  scene.joints = {{JointKind::slider, 0, 1, Vector3d::Zero(), along, {}},
                  {JointKind::slider, 1, 2, Vector3d::Zero(), Vector3d::UnitZ(), {}}};
  scene.joints[0].program = {{0.2, 24.0},  {0.3, -24.0}, {0.4, 0.0},
                             {1.2, -16.0}, {1.3, 16.0},  {1.4, 0.0}};
  scene.joints[1].program = {{0.0, 60.0},  {0.3, 40.0},  {0.6, 0.0},
                             {1.0, -60.0}, {1.3, -40.0}, {1.6, 0.0}};
  return scene;
}

TEST(RivalsJudge, KnowsHowFarFeetWalk) {
  Scene scene = walker();
  EXPECT_NEAR(wayOfFeet(scene), 0.04, 1e-12);
  const Vector3d along(0.6, 0.8, 0), across(-0.8, 0.6, 0);
  // By hand: the inner frame goes while the outer one stands, which slips by 2 mm, and back.
  const auto run = [&](double slip, double drift) {
    Trajectory made = sampled(scene, [](double, BodyState&) {});
    for (std::size_t k = 0; k < made.size(); ++k) {
      const double t = static_cast<double>(k) * scene.sample;
      made[k][2].position += (t > 0.3 ? 0.04 : 0.0) * along + drift * t * across;
      made[k][0].position += (t > 1.3 ? 0.04 : 0.0) * along;
      if (t > 0.3 && t < 0.5) made[k][0].position += slip * across;
    }
    return made;
  };
  Measures m = measure(scene, run(0.0, 0.0));
  EXPECT_NEAR(m.at("off_mm"), 0.0, 1e-9);
  EXPECT_NEAR(m.at("aside_mm"), 0.0, 1e-9);
  EXPECT_NEAR(m.at("slip_mm"), 0.0, 1e-9);
  m = measure(scene, run(2e-3, 1e-3));
  EXPECT_NEAR(m.at("slip_mm"), 2.0, 1e-9);
  EXPECT_NEAR(m.at("aside_mm"), 2.0, 1e-9);
  // Frames that go by different ways are no walker.
  scene.joints[0].program[0].second = 25.0;
  EXPECT_THROW(wayOfFeet(scene), std::invalid_argument);
}

}  // namespace
}  // namespace rivals::machines
