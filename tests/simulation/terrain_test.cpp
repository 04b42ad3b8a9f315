// SPDX-License-Identifier: Apache-2.0
/// Robots on legs and on wheels stand and move on height fields.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/io/simulation/simulation.hpp"
#include "tests/io/temp_folder.hpp"
#include "tests/simulation/data_file.hpp"
#include "tests/simulation/terrain_robots.hpp"
#include "tests/support/matchers.hpp"
#include "tests/validation/shared.hpp"

namespace softgauss::test {
namespace {

/// Hills of ± `amplitude` on a slope along x.
struct Hills {
  double amplitude, wave, slope = 0.0;
  static constexpr double kSize = 8.0, kCell = 0.05;  ///< [m]

  double operator()(double x, double y) const {
    const double k = 2 * M_PI / wave;
    return amplitude * std::sin(k * x) * std::cos(k * y) + slope * x;
  }
  Vector3 normal(double x, double y) const {
    const double k = 2 * M_PI / wave;
    return Vector3(-amplitude * k * std::cos(k * x) * std::cos(k * y) - slope,
                   amplitude * k * std::sin(k * x) * std::sin(k * y), 1.0)
        .normalized();
  }
  /// A row of heights for each y, the largest first.
  std::string table() const {
    std::ostringstream text;
    text.precision(9);
    const int n = static_cast<int>(std::lround(kSize / kCell));
    for (int row = 0; row <= n; ++row)
      for (int column = 0; column <= n; ++column)
        text << (*this)(kCell * column - kSize / 2, kSize / 2 - kCell * row)
             << (column < n ? "," : "\n");
    return text.str();
  }
};

/// A scene of one robot on hills.
struct OnHills {
  /// `scene` lacks the ground, and has HIGH for the height of the robot: it begins where its lowest
  /// point touches. `urdf` may be empty.
  OnHills(const Hills& terrain, const std::string& scene, const std::string& urdf)
      : hills(terrain), sim(load(scene, urdf, kHigh)) {
    sim = load(scene, urdf, kHigh + depth());
  }

  /// How deep the robot's spheres, capsules and rims of cylinders are in the hills [m].
  std::vector<double> depths() const {
    Kinematics kinematics(sim.model());
    computeKinematics(sim.model(), sim.state(), kinematics);
    std::vector<double> all;
    for (const Geometry& g : sim.model().geometries) {
      if (g.body == 0) continue;
      const Transform X_WG = kinematics.X_WB[idx(g.body)] * g.X_BG;
      for (const Vector3& p_G : pointsOf(g.shape)) {
        const Vector3 p = X_WG * p_G;
        const double radius = g.shape.kind == ShapeKind::cylinder ? 0.0 : g.shape.radius;
        all.push_back(radius + (hills(p.x(), p.y()) - p.z()) * hills.normal(p.x(), p.y()).z());
      }
    }
    return all;
  }
  double depth() const {
    const std::vector<double> all = depths();
    return *std::max_element(all.begin(), all.end());
  }
  /// It has landed and stands: what follows is judged.
  void begin() {
    deepest = -kInfinity;
    arrives = 0.0;
    stands = depth();
  }
  /// How deep a foot or a wheel may be [m]: twice as deep as it stands, for what walks stands on
  /// half of its feet, and v τ/e farther, τ = 0.019 s, where it arrives at v. Between the points of
  /// its grid, 5 cm apart, a field of curvature 0.7/m is 0.2 mm lower than its hills.
  double mayBeDeep() const { return 2.0 * stands + arrives * 0.019 / M_E + 0.2e-3; }
  /// Steps until `seconds` from the start; keeps the deepest, and how fast the fastest arrived.
  template <class Control>
  void run(double seconds, Control&& control) {
    std::vector<double> before = depths();
    while (sim.time() < seconds - 1e-9) {
      control();
      ASSERT_FALSE(isRefused(sim.step())) << sim.failure();
      const std::vector<double> after = depths();
      for (std::size_t i = 0; i < after.size(); ++i) {
        deepest = std::max(deepest, after[i]);
        if (before[i] <= 0.0 && after[i] > 0.0)
          arrives = std::max(arrives, (after[i] - before[i]) / sim.model().options.timestep);
      }
      before = after;
    }
  }
  void run(double seconds) {
    run(seconds, [] {});
  }

  Hills hills;
  io::TempFolder folder;
  Simulation sim;
  double deepest = -kInfinity, arrives = 0.0, stands = 0.0;

 private:
  static constexpr double kHigh = 2.0;  ///< above all hills [m]

  Simulation load(std::string scene, const std::string& urdf, double high) {
    const std::string word = "HIGH";
    scene.replace(scene.find(word), word.size(), std::to_string(high));
    folder.write("hills.csv", hills.table());
    folder.write("robot.urdf", urdf);
    const std::string ground =
        "ground: none\n"
        "objects:\n"
        "  - {name: hills, heights: {file: hills.csv, size: [8, 8], height: 1}}\n";
    return Simulation::load(folder.write("scene.yaml", ground + scene));
  }
  static std::vector<Vector3> pointsOf(const Shape& s) {
    std::vector<Vector3> points;
    constexpr int kAround = 64, kAlong = 8;
    if (s.kind == ShapeKind::sphere) points.push_back(Vector3::Zero());
    if (s.kind == ShapeKind::capsule)
      for (int i = 0; i <= kAlong; ++i)
        points.push_back(s.halfLength * (2.0 * i / kAlong - 1.0) * Vector3::UnitZ());
    if (s.kind == ShapeKind::cylinder)
      for (int i = 0; i < kAround; ++i)
        for (const double z : {-s.halfLength, s.halfLength})
          points.emplace_back(s.radius * std::cos(2 * M_PI * i / kAround),
                              s.radius * std::sin(2 * M_PI * i / kAround), z);
    return points;
  }
};

/// Joints of the humanoid, with its soles along the hills under them.
std::string alongGround(const Hills& hills, double ankle) {
  std::string joints;
  for (const double side : {-1.0, 1.0}) {
    const Vector3 n = hills.normal(0.0, 0.095 * side);
    const std::string name = side > 0.0 ? "left" : "right";
    joints += name + "_ankle_pitch: " + std::to_string(ankle + std::atan2(-n.x(), n.z())) + ", " +
              name + "_ankle_roll: " + std::to_string(side * std::atan2(-n.y(), n.z())) + ", ";
  }
  return joints;
}

/// data/scenes/humanoid_steps.yaml without a ground, the humanoid's soles along the hills.
std::string stepsOn(const Hills& hills) {
  std::ifstream file(sceneFile("humanoid_steps"));
  std::stringstream text;
  text << file.rdbuf();
  std::string scene = text.str();
  const auto put = [&](const std::string& old, const std::string& next) {
    scene.replace(scene.find(old), old.size(), next);
  };
  put("../robots/humanoid.urdf", robot("humanoid") + "\n    position: [0, 0, HIGH]");
  put("right_ankle_pitch: 0.3,", "");
  put("left_ankle_pitch: 0.3", alongGround(hills, 0.3));
  return scene;
}

/// Its goals for feet go along the ground, and are quick: on the slope a foot is lifted late, for
/// the centre of mass is on its way longer.
void putFeetAlong(const Hills& hills, Simulation& sim) {
  for (std::size_t i = 0; i < sim.goals.size(); ++i) {
    auto* reach = dynamic_cast<gdd::Reach*>(&sim.goals[i]);
    if (!reach || reach->link == "pelvis") continue;
    Vector3& p = reach->p_WTarget;
    const Vector3 n = hills.normal(p.x(), p.y());
    reach->R_WTarget = Quaternion::FromTwoVectors(Vector3::UnitZ(), n).toRotationMatrix();
    reach->weight = 1e4;
    reach->stiffness = 225.0;
    reach->damping = 30.0;
    p.z() = hills(p.x(), p.y()) + p.z() / n.z();
  }
}

/// Upright: the link's z axis within 30° of the vertical.
bool isUpright(const Simulation& sim, const std::string& link) {
  return sim.pose(link).R(2, 2) > std::cos(M_PI / 6);
}

}  // namespace

// The steps of data/scenes/humanoid_steps.yaml on hills of ±2 cm, 2.4 m apart, of which it stands
// on the steepest place: each foot is put down along the ground, which it is told. Four steps are
// taken and it stands again. The steps are open-loop: on hills 1.2 m apart it falls.
TEST(Terrain, AHumanoidWalksInPlaceOnASlopeOfHills) {
  const Hills hills{0.02, 2.4};
  OnHills s(hills, stepsOn(hills), "");
  putFeetAlong(hills, s.sim);
  s.run(1.0);
  s.begin();
  constexpr double kSole = 0.08;  // below the foot's origin
  for (const auto& [time, foot] : {std::pair(1.79, "right_foot"), std::pair(3.89, "left_foot"),
                                   std::pair(5.99, "right_foot"), std::pair(8.09, "left_foot")}) {
    s.run(time);
    const Vector3 p = s.sim.pose(foot).p;
    EXPECT_GT(p.z() - kSole - hills(p.x(), p.y()), 0.02) << foot << " at " << time;
    EXPECT_SMALL(s.sim.contactForceOn(foot).norm(), 1e-9) << foot << " at " << time;
  }
  s.run(11.0);
  EXPECT_LT(s.deepest, s.mayBeDeep());
  EXPECT_TRUE(isUpright(s.sim, "torso"));
  EXPECT_SMALL(s.sim.pose("pelvis").p.z() - 0.885, 0.02);
  EXPECT_SMALL(s.sim.state().v.cwiseAbs().maxCoeff(), 2e-2);
  for (const char* foot : {"left_foot", "right_foot"}) {
    EXPECT_GT(s.sim.contactForceOn(foot).z(), 150.0);  // of 401 N
    EXPECT_SMALL(s.sim.pose(foot).p.x(), 0.02) << "where it stood";
  }
}

// A quadruped trots over hills of ±2 cm, 1 m apart: two feet across are lifted at a time. It knows
// the height of the ground where it puts a foot down. On ±4 cm it falls.
TEST(Terrain, AQuadrupedTrotsOverHills) {
  const Hills hills{0.02, 1.0};
  OnHills s(hills, kQuadrupedScene, quadrupedUrdf());
  Trot trot(s.sim, hills);
  constexpr double kStand = 1.5, kEnd = 7.5;
  s.run(kStand, [&] { trot.stand(); });
  s.begin();
  EXPECT_SMALL(s.sim.state().v.cwiseAbs().maxCoeff(), 0.05) << "stands";
  const Vector3 start = s.sim.pose("trunk").p;
  double lifted = 0.0;
  s.run(kEnd, [&] {
    trot.walk(kStand);
    const Vector3 foot = s.sim.pose("front_left_shank") * Trot::kFootInShank;
    lifted = std::max(lifted, foot.z() - Trot::kFootRadius - hills(foot.x(), foot.y()));
    ASSERT_GT(s.sim.pose("trunk").R(2, 2), 0.99) << "level, at " << s.sim.time();
  });
  s.run(kEnd + 1.0, [&] { trot.stand(); });
  const Vector3 way = s.sim.pose("trunk").p - start;
  EXPECT_LT(s.deepest, s.mayBeDeep());
  EXPECT_GT(lifted, 0.02);
  EXPECT_NEAR(way.x(), Trot::kSpeed * (kEnd - kStand), 0.02);
  EXPECT_SMALL(way.y(), 0.02);
  EXPECT_SMALL(s.sim.state().v.cwiseAbs().maxCoeff(), 0.05) << "stands again";
}

// A robot on four driven wheels stands on a slope of 12 % with hills of ±2 cm, 1.5 m apart, and
// drives up it as far as its wheels turn. The motors' work is what lifts it, and more.
TEST(Terrain, AWheeledRobotDrivesUpASlope) {
  const Hills hills{0.02, 1.5, 0.12};
  OnHills s(hills, kRoverScene, roverUrdf());
  Wheels wheels(s.sim);
  constexpr double kStand = 1.0, kEnd = 6.0, kSpeed = 5.0;  // [rad/s]
  s.run(kStand, [&] { wheels.drive(0.0); });
  s.begin();
  EXPECT_SMALL(s.sim.state().v.cwiseAbs().maxCoeff(), 0.01) << "stands";
  const Vector3 start = s.sim.pose("chassis").p;
  const double angle = wheels.angle(), work = wheels.work;
  s.run(kEnd, [&] { wheels.drive(kSpeed); });
  s.run(kEnd + 1.0, [&] { wheels.drive(0.0); });
  const Vector3 end = s.sim.pose("chassis").p, way = end - start;
  // Along the hills under its middle; the wheels' way differs from that by some of their radius.
  double length = 0.0;
  constexpr int kParts = 1000;
  for (int i = 0; i < kParts; ++i) {
    const double dx = way.x() / kParts, x = start.x() + i * dx;
    length += std::hypot(dx, hills(x + dx, 0.0) - hills(x, 0.0));
  }
  EXPECT_NEAR(kWheelRadius * (wheels.angle() - angle) / length, 1.0, 0.02);
  EXPECT_GT(way.x(), 1.9);
  EXPECT_NEAR(way.z(), hills(end.x(), 0.0) - hills(start.x(), 0.0), 0.02);
  EXPECT_GT(wheels.work - work, 12.0 * kGravity * way.z());
  EXPECT_SMALL(way.y(), 0.02);
  EXPECT_LT(s.deepest, s.mayBeDeep());
  EXPECT_TRUE(isUpright(s.sim, "chassis"));
}

}  // namespace softgauss::test
