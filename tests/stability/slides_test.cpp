// SPDX-License-Identifier: Apache-2.0
/// What slides is not lifted, keeps its line, and stops where Coulomb's law says (5.8), (5.9).

#include <fmt/format.h>

#include <cmath>

#include "tests/stability/scenes.hpp"

namespace softgauss::test {
namespace {

/// A throw over level ground.
struct Throw {
  double speed = 3.0, friction = 0.5;
  double direction = 0.0;  ///< of the throw, from x [rad]
  double turned = 0.0;     ///< the body about the vertical [rad]
  Cone cone = Cone::pyramidal;
  double timestep = 0.002;

  std::string name(const char* body) const {
    return fmt::format("{} of friction {} at {} m/s, {:.0f} deg, turned by {:.0f}, {}, {} ms", body,
                       friction, speed, direction * 180.0 / M_PI, turned * 180.0 / M_PI,
                       cone == Cone::pyramidal ? "pyramids" : "elliptic cones", 1e3 * timestep);
  }
  Vector3 way() const { return {std::cos(direction), std::sin(direction), 0.0}; }
  double stopsAfter() const { return speed * speed / (2.0 * friction * 9.81); }
};

ModelBuilder thrown(const Throw& t, const Shape& shape, double height) {
  ModelBuilder builder("throw");
  builder.link(emptyLink("world"));
  builder.geometry(groundSpec(t.friction));
  const Matrix3 turned = Eigen::AngleAxisd(t.turned, Vector3::UnitZ()).toRotationMatrix();
  addBody(builder, "body", shape, 1.0, {turned, Vector3(0.0, 0.0, height)}, t.friction);
  builder.options.levelSlip = true;
  builder.options.integrator = Integrator::leapfrog;
  return with(std::move(builder), t.timestep, t.cone);
}

/// A cube of 0.1 m: level on the ground it rises by at most 1 mm, tilts by at most 1°, and leaves
/// its line by at most 1 % of its way. It stops within 2 % of v²/(2 μ g), a step's way, and what
/// its contacts give: as long as friction is μ f_n, ẍ + μ z̈ = −μ g, so that it slides farther by μ
/// times its depth.
void throwCube(const Throw& t) {
  Trial trial(t.name("cube"), thrown(t, Shape::box(Vector3(0.05, 0.05, 0.05)), 0.05));
  trial.state.v.head<3>() = t.speed * t.way();
  trial.mayGain = 1e-3;
  double rises = 0.0, tilts = 0.0;
  trial.run(1.2 * t.speed / (t.friction * 9.81) + 0.2, [&] {
    rises = std::max(rises, trial.origin("body").z() - 0.05);
    tilts = std::max(tilts, tilt(trial, "body"));
  });
  const Vector3 at = trial.origin("body");
  const double along = at.dot(t.way()), across = at.dot(Vector3::UnitZ().cross(t.way()));
  trial.expect("rises by", rises, 1e-3, "m");
  trial.expect("tilts by", tilts, M_PI / 180.0, "rad");
  trial.expect("stops off by", along - t.stopsAfter(),
               0.02 * t.stopsAfter() + t.speed * t.timestep + t.friction * trial.deepest, "m");
  trial.expect("drifts by", across / t.stopsAfter(), 0.01, "of its way");
}

class Slides : public testing::TestWithParam<double> {};

TEST_P(Slides, ThrownCubesStayLevelAndStopByCoulombsLaw) {
  for (const Cone cone : kCones)
    for (const double friction : {0.3, 0.5, 0.8, 1.0})
      for (const double speed : {1.0, 3.0, 6.0})
        for (const double degrees : {0.0, 22.5, 37.0, 45.0})
          throwCube({speed, friction, degrees * M_PI / 180.0, 0.0, cone, GetParam()});
}

INSTANTIATE_TEST_SUITE_P(Steps, Slides, testing::Values(0.0005, 0.002, 0.005, 0.01));

}  // namespace
}  // namespace softgauss::test
