// SPDX-License-Identifier: Apache-2.0
/// What slides is pressed by its load, keeps its line, and stops where Coulomb's law says (5.8): by
/// default, and without Mechanism::nearRigid.

#include <fmt/format.h>

#include <cmath>

#include "tests/stability/scenes.hpp"

namespace softgauss::test {
namespace {

/// A throw over level ground.
struct Throw {
  double speed = 3.0, friction = 0.5;
  double direction = 0.0;  ///< of the throw, from x [rad]
  Cone cone = Cone::pyramidal;
  double timestep = 0.002;
  bool nearRigid = true;

  std::string name(const char* body) const {
    return fmt::format("{} of friction {} at {} m/s, {:.0f} deg, {}, {} ms{}", body, friction,
                       speed, direction * 180.0 / M_PI,
                       cone == Cone::pyramidal ? "pyramids" : "elliptic cones", 1e3 * timestep,
                       nearRigid ? "" : ", without near_rigid");
  }
  Vector3 way() const { return {std::cos(direction), std::sin(direction), 0.0}; }
  double stopsAfter() const { return speed * speed / (2.0 * friction * 9.81); }
};

ModelBuilder thrown(const Throw& t, const Shape& shape, double height) {
  ModelBuilder builder("throw");
  builder.link(emptyLink("world"));
  builder.geometry(groundSpec(t.friction));
  addBody(builder, "body", shape, 1.0, {Matrix3::Identity(), Vector3(0.0, 0.0, height)},
          t.friction);
  if (!t.nearRigid) builder.options.mechanisms.remove(Mechanism::nearRigid);
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
    for (const double friction : {0.3, 0.5, 0.8, 0.95})
      for (const double speed : {1.0, 3.0, 6.0})
        for (const double degrees : {0.0, 22.5, 37.0, 45.0})
          for (const bool nearRigid : {false, true})
            throwCube({speed, friction, degrees * M_PI / 180.0, cone, GetParam(), nearRigid});
}

/// A slab held by a soft spring on a belt of 1 m/s, which goes along and askew to its tangents: the
/// belt presses it with its weight, to 1 %, 5 % at 10 ms, and drags it by μ times that.
TEST_P(Slides, SlabsOnABeltArePressedByTheirWeight) {
  for (const Cone cone : kCones)
    for (const double friction : {0.3, 1.0})
      for (const auto& [degrees, nearRigid] : {std::pair(0.0, true), {30.0, false}, {30.0, true}}) {
        const Throw t{1.0, friction, degrees * M_PI / 180.0, cone, GetParam(), nearRigid};
        const Matrix3 turned = Eigen::AngleAxisd(t.direction, Vector3::UnitZ()).toRotationMatrix();
        ModelBuilder builder("belt");
        builder.base = BaseKind::fixed;
        builder.link(emptyLink("world"));
        builder.link(boxLink("belt", 1e4, Vector3(50.0, 1.0, 0.1)));
        builder.joint(jointSpec("slide", JointType::prismatic, "world", "belt",
                                {turned, Vector3(0.0, 0.0, -0.1)}, Vector3::UnitX()));
        builder.geometry(geometrySpec("belt", Shape::box(Vector3(50.0, 1.0, 0.1)), friction));
        if (!nearRigid) builder.options.mechanisms.remove(Mechanism::nearRigid);
        addBody(builder, "slab", Shape::box(Vector3(0.1, 0.1, 0.02)), 1.0,
                {Matrix3::Identity(), Vector3(0.0, 0.0, 0.02)}, friction);
        Trial trial(t.name("slab"), with(std::move(builder), t.timestep, cone));
        trial.mayGain = trial.mayRise = kInfinity;  // the belt drives
        const Body& slab = trial.model.bodies.back();
        int belt = 0;
        for (const Body& b : trial.model.bodies)
          if (b.joint == JointKind::prismatic) belt = b.v;
        trial.input.tau = VectorX::Zero(trial.model.nv);
        trial.state.v[belt] = t.speed;
        double least = kInfinity, most = 0.0;
        Vector3 drag = Vector3::Zero();
        const int last = static_cast<int>(3.0 / t.timestep);
        trial.run(3.0, [&] {
          const Vector3 p = trial.state.q.segment<3>(slab.q), v = trial.state.v.segment<3>(slab.v);
          trial.input.tau.segment<3>(slab.v) =
              Vector3(-100.0 * p.x() - 20.0 * v.x(), -100.0 * p.y() - 20.0 * v.y(), 0.0);
          if (trial.steps < last / 2) return;
          double pressed = 0.0;
          trial.data->constraints.visitContacts([&](const auto& rows) {
            for (std::size_t i = 0; i < rows.contactsWithRows().size(); ++i)
              pressed += rows.frameForce(static_cast<int>(i))[0];
          });
          least = std::min(least, pressed), most = std::max(most, pressed);
          drag = 100.0 * Vector3(p.x(), p.y(), 0.0);
        });
        const double within = t.timestep < 0.01 ? 0.01 : 0.05;
        trial.expect("pressed at least beside its weight", 1.0 - least / 9.81, within, "");
        trial.expect("pressed at most beside its weight", most / 9.81 - 1.0, within, "");
        trial.expect("dragged beside Coulomb's", (drag - friction * 9.81 * t.way()).norm() / 9.81,
                     within, "");
      }
}

INSTANTIATE_TEST_SUITE_P(Steps, Slides, testing::Values(0.0005, 0.002, 0.005, 0.01));

}  // namespace
}  // namespace softgauss::test
