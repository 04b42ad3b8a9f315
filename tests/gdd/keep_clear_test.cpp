// SPDX-License-Identifier: Apache-2.0
/// Keeping clear: the cost, its derivatives, and what an arm does that reaches past an obstacle.

#include "softgauss/collision/clearance.hpp"
#include "tests/gdd/goal_check.hpp"
#include "tests/gdd/robot_scene.hpp"
#include "tests/support/sample_surfaces.hpp"

namespace softgauss::test {
namespace {

using collision::Clearance;

/// An arm of boxes and balls beside a ball that is fixed to the world, in a random state.
Scene armBesideABall(std::uint64_t seed) {
  Random random(seed);
  ModelBuilder builder = chain(5);
  for (int i = 0; i < 5; ++i)
    builder.geometry(geometrySpec("link" + std::to_string(i), i % 2 == 0
                                                                  ? Shape::box({0.03, 0.04, 0.1})
                                                                  : Shape::sphere(0.05)));
  GeometrySpec ball = geometrySpec("world", Shape::sphere(0.1));
  ball.X_LG.p = random.vector3(0.7);
  builder.geometry(ball);
  Scene scene(builder.build());
  scene.state.q = random.vector(5, 1.0);
  scene.state.v = random.vector(5, 2.0);
  EXPECT_EQ(scene.stages(), SolveStatus::converged);
  return scene;
}

/// ℓ of a goal and its gradient at a, sides chosen there.
struct CostAt {
  const Scene& scene;
  gdd::GoalCost cost;

  CostAt(const Scene& s, const gdd::Goal& goal) : scene(s), cost(s.model.nv) {
    goal.addCost({s.model, s.state, *s.data}, cost);
  }
  VectorX times(const VectorX& a) const {
    VectorX Ma(a.size());
    scene.data->inertia.M.multiply(a, Ma);
    return Ma;
  }
  double value(const VectorX& a) {
    cost.chooseSides(a);
    return cost.value(a, times(a));
  }
  VectorX gradient(const VectorX& a) {
    cost.chooseSides(a);
    VectorX g(a.size());
    cost.gradient(a, times(a), g);
    return g;
  }
};

/// The nearest points without the corners beside them.
class NearestAlone final : public ShapeDistances {
 public:
  explicit NearestAlone(const Model& model) : all_(model) {}
  std::span<const NearPoints> between(int a, const Transform& X_WA, int b,
                                      const Transform& X_WB) noexcept override {
    const auto points = all_.between(a, X_WA, b, X_WB);
    return points.first(std::min<std::size_t>(points.size(), 1));
  }

 private:
  Clearance all_;
};

gdd::KeepClear clearOfTheWorld(const Scene& s, const std::string& link, double distance) {
  return {s.model, link, "world", distance, std::make_shared<Clearance>(s.model)};
}

}  // namespace

// Differences of a function with a gradient without jumps, over 1e-5 of a: 1e-5 of its curvature.
TEST(KeepClear, GradientIsThatOfTheValue) {
  int active = 0, idle = 0;
  double worst = 0.0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Scene s = armBesideABall(seed);
    Random random(seed + 5);
    gdd::KeepClear goal = clearOfTheWorld(s, "link4", random.uniform(0.1, 1.0));
    goal.weight = 2.0;
    CostAt at(s, goal);
    for (int i = 0; i < 10; ++i) {
      const VectorX a = random.vector(5, 60.0), d = random.vector(5, 1.0);
      const double h = 1e-5;
      const double slope = (at.value(a + h * d) - at.value(a - h * d)) / (2.0 * h);
      const VectorX gradient = at.gradient(a);
      (at.value(a) > 0.0 ? active : idle) += 1;
      worst = std::max(worst, std::abs(slope - gradient.dot(d)) / (1.0 + gradient.norm()));
      if (at.value(a) == 0.0) {
        EXPECT_EQ(gradient.norm(), 0.0) << "and no slope where it is zero";
      }
    }
  }
  EXPECT_GT(active, 50);
  EXPECT_GT(idle, 50);
  EXPECT_SMALL(worst, 1e-4);
}

// Between any two accelerations the cost lies below the chord, and its gradient never turns back.
TEST(KeepClear, IsConvexInTheAcceleration) {
  double above = 0.0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Scene s = armBesideABall(seed);
    Random random(seed + 9);
    const gdd::KeepClear goal = clearOfTheWorld(s, "link4", 0.4);
    CostAt at(s, goal);
    for (int i = 0; i < 10; ++i) {
      const VectorX a = random.vector(5, 60.0), b = random.vector(5, 60.0);
      const double ends = 0.5 * (at.value(a) + at.value(b)), size = 1e-12 * (1.0 + ends);
      EXPECT_LE(at.value(0.5 * (a + b)), ends + size);
      EXPECT_GE((at.gradient(a) - at.gradient(b)).dot(a - b), -size);
      above = std::max(above, (ends - at.value(0.5 * (a + b))) / (1.0 + ends));
    }
  }
  EXPECT_GT(above, 0.1) << "it is no plane";
}

// ½ w Σ (y − d̈)²₊ with ḋ and d̈ from differences of distances of moved poses, for balls, of which
// the nearest points are those of their centres' line: d̈ lacks the term |ṗ_⊥|²/r of its turning.
TEST(KeepClear, WeighsHowFastTheDistanceShrinks) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Scene s = armBesideABall(seed);
    Random random(seed + 3);
    const gdd::KeepClear goal = clearOfTheWorld(s, "link3", 0.5);
    ASSERT_EQ(goal.pairs.size(), 1u);
    const Geometry& ball = s.model.geometries[static_cast<std::size_t>(goal.pairs[0].a)];
    const Geometry& fixed = s.model.geometries[static_cast<std::size_t>(goal.pairs[0].b)];
    const Kinematics& k = s.data->kinematics;
    const Vector3 p = k.X_WB[static_cast<std::size_t>(ball.body)] * ball.X_BG.p;
    const Vector3 n = (fixed.X_BG.p - p).normalized();
    const double d = (fixed.X_BG.p - p).norm() - 0.15;
    const VectorX a = random.vector(5, 20.0);
    Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, 5);
    // The nearest point of the link is a point of its ball, which turns with it.
    const Vector3 x = p + 0.05 * n;
    pointJacobian(s.model, k, ball.body, x, J);
    const double rate = -n.dot(J * s.state.v);
    const double bend = -n.dot(J * a + pointBiasAcceleration(s.model, k, ball.body, x));
    const double y = -goal.stiffness * (d - goal.distance) - goal.damping * rate;
    const double short_ = std::max(0.0, y - bend);
    CostAt at(s, goal);
    EXPECT_NEAR(at.value(a), 0.5 * goal.weight * short_ * short_,
                1e-9 * (1.0 + goal.weight * short_ * short_));
  }
}

// d̈ of boxes: second differences of their distance along a motion that accelerates evenly. It is
// what the cost has, or more where round ways are left out: corner against corner.
TEST(KeepClear, KnowsHowFacesAndEdgesTurn) {
  int exact = 0, checked = 0;
  double below = 0.0;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    Random random(seed);
    ModelBuilder builder = chain(5);
    builder.geometry(geometrySpec("link4", Shape::box({0.06, 0.05, 0.1})));
    builder.geometry(geometrySpec("world", Shape::box({0.1, 0.08, 0.12}), 1.0,
                                  {random.rotation(), random.vector3(0.6)}));
    Scene s(builder.build());
    s.state.q = random.vector(5, 1.0);
    s.state.v = random.vector(5, 3.0);
    ASSERT_EQ(s.stages(), SolveStatus::converged);
    const gdd::KeepClear goal(s.model, "link4", "world", 100.0,  // so far that it counts
                              std::make_shared<NearestAlone>(s.model));
    const auto distanceAt = [&](double t, const VectorX& a) {
      Scene moved(s.model);
      moved.state.q = s.state.q + t * s.state.v + 0.5 * t * t * a;
      EXPECT_EQ(moved.stages(), SolveStatus::converged);
      return *goal.clearance({moved.model, moved.state, *moved.data});
    };
    const VectorX a = random.vector(5, 5.0);
    const double h = 1e-4, d = distanceAt(0.0, a);
    const double ahead = distanceAt(h, a), behind = distanceAt(-h, a);
    const double bend = (ahead - 2.0 * d + behind) / (h * h), rate = (ahead - behind) / (2.0 * h);
    if (d < 0.02 || std::abs(bend) > 100.0) continue;  // a kink lies within the difference
    ++checked;
    const double y = -goal.stiffness * (d - goal.distance) - goal.damping * rate;
    const double known = y - std::sqrt(2.0 * CostAt(s, goal).value(a) / goal.weight);
    // Differences of 1e-10 m over 1e-8 s², and rates of 1e-6 m/s with 40 1/s.
    below = std::max(below, known - bend);
    exact += std::abs(known - bend) < 0.05;
  }
  EXPECT_GT(checked, 40);
  EXPECT_GT(exact, checked / 6);
  EXPECT_SMALL(below, 0.05);
}

TEST(KeepClear, RefusesWhatCannotBeKeptClear) {
  const Scene s = armBesideABall(1);
  const auto shapes = std::make_shared<Clearance>(s.model);
  using gdd::KeepClear;
  EXPECT_THROW(KeepClear(s.model, "no such link", "world", 0.1, shapes), ModelError);
  EXPECT_THROW(KeepClear(s.model, "link4", "no such link", 0.1, shapes), ModelError);
  EXPECT_THROW(KeepClear(s.model, "link4", "link3", 0.1, shapes), ModelError) << "joined";
  EXPECT_THROW(KeepClear(s.model, "link4", "link4", 0.1, shapes), ModelError);
  EXPECT_THROW(KeepClear(s.model, "link4", "world", -0.1, shapes), ModelError);
  EXPECT_THROW(KeepClear(s.model, "link4", "world", 0.1, nullptr), ModelError);
  EXPECT_NO_THROW(KeepClear(s.model, "link4", "link1", 0.1, shapes));
}

// ---- What the arm does --------------------------------------------------------------------------

namespace {

const Vector3 kTarget(0.5, 0.3, 0.5);

/// The arm reaches to kTarget past an obstacle beside its way.
struct PastObstacle {
  RobotScene r;
  gdd::KeepClear measure;
  double least = kInfinity;  ///< clearance of the hand [m]
  int unfinished = 0;

  PastObstacle(const Shape& obstacle, double distance, bool keepsClear)
      : r("arm", {fixtureOf(obstacle)}),
        measure(r.model, "hand", "world", distance, std::make_shared<Clearance>(r.model)) {
    r.addReach("hand", kTarget);
    r.addPosture().weight = 0.01;
    r.addDamping().weight = 0.1;
    if (keepsClear) r.controller.goals.push_back(std::make_unique<gdd::KeepClear>(measure));
  }
  void run(double seconds) {
    while (r.state.time < seconds && !testing::Test::HasFatalFailure()) {
      ASSERT_FALSE(isRefused(r.step()));
      unfinished += r.controller.report.status == gdd::GddStatus::iterationLimit;
      least = std::min(least, *measure.clearance({r.model, r.state, r.data}));
    }
  }
  static GeometrySpec fixtureOf(const Shape& obstacle) {
    GeometrySpec spec = geometrySpec("world", obstacle);
    const Vector3 start = RobotScene("arm").position("hand");
    spec.X_LG.p = start + 0.6 * (kTarget - start) + Vector3(0.01, 0.02, -0.03);
    return spec;
  }
};

}  // namespace

TEST(KeepClearBehaviour, TheArmReachesPastAnObstacleAndKeepsItsDistance) {
  constexpr double kDistance = 0.04;
  const Shape obstacles[] = {Shape::sphere(0.05), Shape::box({0.04, 0.04, 0.04}),
                             Shape::surface(ballSurface(0.05, 8, 12))};
  for (const Shape& obstacle : obstacles) {
    SCOPED_TRACE(static_cast<int>(obstacle.kind));
    PastObstacle without(obstacle, kDistance, false), with(obstacle, kDistance, true);
    without.run(3.0);
    with.run(3.0);
    EXPECT_LT(without.least, kDistance - 0.01) << "its way leads through there";
    EXPECT_GT(with.least, kDistance - 1e-3);
    EXPECT_LT(with.least, kDistance + 0.01) << "it makes no wider way than it must";
    EXPECT_SMALL((with.r.position("hand") - kTarget).norm(), 0.01);
    EXPECT_EQ(with.unfinished, 0);
    std::vector<gdd::GoalError> figures;
    with.measure.errors({with.r.model, with.r.state, with.r.data}, {}, figures);
    ASSERT_EQ(figures.size(), 1u);
    EXPECT_LE(figures[0].value, figures[0].met);
  }
}

// A place behind the surface: the arm stays before it, at the distance.
TEST(KeepClearBehaviour, AReachIntoTheObstacleEndsAtTheDistance) {
  constexpr double kDistance = 0.03;
  RobotScene r("arm", {[] {
                 GeometrySpec wall = geometrySpec("world", Shape::box({0.05, 0.6, 0.6}));
                 wall.X_LG.p = Vector3(0.6, 0.0, 0.6);
                 return wall;
               }()});
  r.addReach("hand", Vector3(0.6, 0.1, 0.6));
  r.addPosture().weight = 0.01;
  r.addDamping();
  auto goal = std::make_unique<gdd::KeepClear>(r.model, "hand", "world", kDistance,
                                               std::make_shared<Clearance>(r.model));
  const gdd::KeepClear& keep = *goal;
  r.controller.goals.push_back(std::move(goal));
  double least = kInfinity;
  for (int i = 0; i < 2000; ++i) {
    ASSERT_FALSE(isRefused(r.step()));
    least = std::min(least, *keep.clearance({r.model, r.state, r.data}));
  }
  EXPECT_GT(least, kDistance - 1e-3);
  EXPECT_NEAR(*keep.clearance({r.model, r.state, r.data}), kDistance, 1e-3);
}

}  // namespace softgauss::test
