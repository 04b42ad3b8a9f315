// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/inverse_derivative.hpp"

#include <functional>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/step/inverse.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_surfaces.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// Of the largest entry: differences of fourth order by 1e-7 keep eight digits.
constexpr double kTolerance = 1e-7;

VectorX inverse(Scene& s, const State& state, const VectorX& a) {
  const State kept = s.state;
  s.state = state;
  s.stages();
  VectorX tau(s.model.nv);
  inverseDynamics(s.model, a, *s.data, tau);
  s.state = kept;
  return tau;
}

/// Compared columns, and those left out because a kink is nearer than the difference's step.
struct Count {
  int compared = 0, kinks = 0;
};

/// Columns of the derivative against central differences; where the differences to both sides are
/// not alike, a kink lies between them.
void expectDerivative(Scene& s, const VectorX& a, Count& count, double tolerance = kTolerance,
                      double kink = kTolerance) {
  constexpr double kStep = 1e-7;
  const int n = s.model.nv;
  InverseDerivative derivative(s.model);
  s.stages();
  ASSERT_EQ(derivative.compute(s.model, s.input, s.state, a, s.contacts.get(), *s.data),
            SolveStatus::converged);
  const VectorX here = inverse(s, s.state, a);
  EXPECT_APPROX(derivative.force(), here, 1e-15);
  const auto column = [&](int j, double by, bool ofPosition) {
    State moved = s.state;
    if (ofPosition)
      integratePosition(s.model, VectorX::Unit(n, j) * by, 1.0, moved.q);
    else
      moved.v[j] += by;
    return inverse(s, moved, a);
  };
  for (const bool ofPosition : {true, false}) {
    const MatrixX& G = ofPosition ? derivative.q() : derivative.v();
    MatrixX expected(n, n);
    VectorX bend(n);
    for (int j = 0; j < n; ++j) {
      const VectorX more = column(j, kStep, ofPosition), less = column(j, -kStep, ofPosition);
      const VectorX far = column(j, 2.0 * kStep, ofPosition) - column(j, -2.0 * kStep, ofPosition);
      // Of fourth order: impedances bend over a millimetre.
      expected.col(j) = (8.0 * (more - less) - far) / (12.0 * kStep);
      bend[j] = (far - 2.0 * (more - less)).cwiseAbs().maxCoeff() / kStep;
    }
    // Third differences: of a smooth function (step/1 mm)² of it, at a kink as much as it misleads.
    const double scale = std::max(1.0, expected.cwiseAbs().maxCoeff());
    std::vector<bool> smooth(n);
    for (int j = 0; j < n; ++j) {
      smooth[j] = bend[j] <= kink * scale;
      ++(smooth[j] ? count.compared : count.kinks);
    }
    for (int j = 0; j < n; ++j) {
      if (!smooth[j]) continue;
      EXPECT_LE((G.col(j) - expected.col(j)).cwiseAbs().maxCoeff(), tolerance * scale)
          << (ofPosition ? "q " : "v ") << j << " of " << s.model.name << "\n"
          << G.col(j).transpose() << "\n"
          << expected.col(j).transpose();
    }
  }
}

/// A sliding contact has kinks of its own, where the slip law begins and where its pyramid turns.
void expectFewKinks(const Count& count) {
  EXPECT_GT(count.compared, 20);
  EXPECT_LT(count.kinks, count.compared / 8);
}

TEST(InverseDerivative, OfTreesSpringsDampingAndWrenches) {
  Count count;
  for (int seed = 0; seed < 40; ++seed) {
    RandomTreeOptions options;
    options.springs = true;
    options.ranges = options.geometries = false;
    Scene s = randomScene(seed, 0, options);
    Random random(seed);
    expectDerivative(s, random.vector(s.model.nv, 10.0), count);
  }
  expectFewKinks(count);
}

TEST(InverseDerivative, OfWeightsThatAreBorne) {
  Count count;
  for (int seed = 0; seed < 20; ++seed) {
    RandomTreeOptions options;
    options.ranges = options.geometries = false;
    Random random(seed);
    Model model = randomScene(seed, 0, options).model;
    for (Body& body : model.bodies)
      if (body.dofs > 0) body.borneMass = 2.0, body.borneCom = random.vector3(0.3);
    Scene s(model);
    s.state = randomScene(seed, 0, options).state;
    expectDerivative(s, random.vector(s.model.nv, 10.0), count);
  }
  expectFewKinks(count);
}

TEST(InverseDerivative, OfTheVelocityOfTurningThatTheLastStepPredicts) {
  Count count;
  for (int seed = 0; seed < 10; ++seed) {
    Scene s = randomScene(seed, 0);
    Random random(seed);
    s.state.a = random.vector(s.model.nv, 100.0);
    s.state.hasAcceleration = true;
    expectDerivative(s, random.vector(s.model.nv, 10.0), count);
  }
  expectFewKinks(count);
}

TEST(InverseDerivative, OfEffectsThatAreSwitchedOff) {
  for (const Effect off : {Effect::gravity, Effect::coriolis, Effect::armature}) {
    Count count;
    Scene s = randomScene(3, 0);
    s.model.options.effects.remove(off);
    Random random(3);
    expectDerivative(s, random.vector(s.model.nv, 10.0), count);
  }
}

TEST(InverseDerivative, OfLimitsAndDryFriction) {
  for (const bool nearRigid : {false, true}) {
    for (const bool controlled : {false, true}) {
      Count count;
      for (int seed = 0; seed < 20; ++seed) {
        RandomTreeOptions options;
        options.dryFriction = true;
        options.geometries = false;
        Scene s = randomScene(seed, 0, options);
        if (!nearRigid) s.model.options.mechanisms.remove(Mechanism::nearRigid);
        if (controlled) s.input.controlled = allTrees(s.model);
        Random random(seed);
        expectDerivative(s, random.vector(s.model.nv, 1.0), count);
      }
      expectFewKinks(count);
    }
  }
}

TEST(InverseDerivative, OfEqualityConstraints) {
  Count count;
  for (int seed = 0; seed < 10; ++seed) {
    RandomTreeOptions options;
    options.equalities = true;
    options.geometries = options.ranges = false;
    Scene s = randomScene(seed, 0, options);
    Random random(seed);
    // Differences themselves, of constraints that are off by as much as impedances bend over.
    expectDerivative(s, random.vector(s.model.nv, 10.0), count, 1e-6, 1e-6);
  }
  expectFewKinks(count);
}

enum class Ground { plane, tilting, ball, box, capsule };

/// A trunk of some shape with an arm of two links, which has the same shape at its end, on a plane,
/// or on a floor that turns about a hinge: a plane, a ball, a box or a capsule.
Model walker(const Shape& foot, Ground ground, const Material& material, std::uint64_t seed) {
  Random random(seed);
  ModelBuilder b("walker");
  const auto at = [&] { return Transform{random.rotation(), random.vector3(0.3)}; };
  const auto add = [&](const char* link, const Shape& shape, const Transform& X) {
    GeometrySpec g = geometrySpec(link, shape, 1.0, X);
    g.material = material;
    b.geometry(g);
  };
  b.link(emptyLink("world"));
  for (const char* link : {"trunk", "upper", "lower"}) b.link(randomLink(link, random));
  b.joint(jointSpec("free", JointType::floating, "world", "trunk"));
  b.joint(jointSpec("a", JointType::continuous, "trunk", "upper", at(), random.direction()));
  b.joint(jointSpec("b", JointType::continuous, "upper", "lower", at(), random.direction()));
  add("trunk", foot, at());
  add("lower", foot, at());
  if (ground == Ground::plane) {
    add("world", Shape::plane(), {random.rotation(), Vector3::Zero()});
    return b.build();
  }
  b.link(randomLink("floor", random));
  b.joint(jointSpec("hinge", JointType::continuous, "world", "floor", at(), random.direction()));
  add("floor",
      ground == Ground::tilting   ? Shape::plane()
      : ground == Ground::ball    ? Shape::sphere(0.3)
      : ground == Ground::capsule ? Shape::capsule(0.1, 0.4)
                                  : Shape::box({0.4, 0.3, 0.2}),
      at());
  return b.build();
}

/// A walker of that seed that moves at `speed`, its deepest point 0.7 mm deep.
Scene walking(const Shape& foot, Ground ground, Material material, double speed,
              std::uint64_t seed) {
  Random random(seed + 100);
  Scene s(walker(foot, ground, material, seed));
  s.model.options.effects.remove(Effect::selfCollision);
  s.state = randomState(s.model, random, speed);
  material.margin = 5.0;
  Model wide = walker(foot, ground, material, seed);
  wide.options.effects.remove(Effect::selfCollision);
  Kinematics k(wide);
  computeKinematics(wide, s.state, k);
  ContactSet found;
  collision::SceneContacts(wide).detect(wide, k, found);
  const Contact* deepest = &found.contacts.at(0);
  for (const Contact& c : found.contacts)
    if (c.distance < deepest->distance) deepest = &c;
  const double sign = wide.bodies[deepest->bodyB].tree == 0 ? 1.0 : -1.0;
  s.state.q.head<3>() += sign * (-7e-4 - deepest->distance) * deepest->n_W;
  s.contacts = std::make_shared<collision::SceneContacts>(s.model);
  s.input.controlled = allTrees(s.model);
  s.stages();
  return s;
}

Shape hull() { return Shape::hull(boxSurface({0.1, 0.06, 0.04})); }

struct Feet {
  Shape foot;
  Ground ground;
};

std::vector<Feet> closedForms() {
  std::vector<Feet> feet;
  for (const Ground ground : {Ground::plane, Ground::tilting})
    for (const Shape& foot : {Shape::sphere(0.06), Shape::capsule(0.04, 0.1),
                              Shape::cylinder(0.08, 0.03), Shape::box({0.1, 0.06, 0.04}), hull()})
      feet.push_back({foot, ground});
  for (const Ground ground : {Ground::ball, Ground::capsule})
    for (const Shape& foot : {Shape::sphere(0.06), Shape::capsule(0.04, 0.1)})
      feet.push_back({foot, ground});
  return feet;
}

void expectContacts(const std::vector<Feet>& feet, const std::function<void(Scene&)>& change,
                    const Material& material, double speed, double tolerance = kTolerance) {
  Count count;
  for (const Feet& f : feet) {
    for (int seed = 0; seed < 4; ++seed) {
      Scene s = walking(f.foot, f.ground, material, speed, seed);
      change(s);
      SCOPED_TRACE(testing::Message() << "shape " << static_cast<int>(f.foot.kind) << " on "
                                      << static_cast<int>(f.ground) << ", seed " << seed);
      Random random(seed);
      expectDerivative(s, random.vector(s.model.nv, 3.0), count, tolerance);
    }
  }
  expectFewKinks(count);
}

TEST(InverseDerivative, OfContacts) {
  for (const int condim : {1, 3, 4, 6}) {
    for (const Cone cone : {Cone::pyramidal, Cone::elliptic}) {
      SCOPED_TRACE(testing::Message() << "condim " << condim << (cone == Cone::elliptic));
      Material material;
      material.condim = condim;
      material.torsionalFriction = 0.1, material.rollingFriction = 0.05;
      expectContacts(
          closedForms(), [&](Scene& s) { s.model.options.cone = cone; }, material, 0.5);
    }
  }
}

TEST(InverseDerivative, OfContactsThatFollowTheirSlip) {
  Material material;
  material.slidingFriction = 0.4;
  for (const Cone cone : {Cone::pyramidal, Cone::elliptic}) {
    expectContacts(
        closedForms(), [&](Scene& s) { s.model.options.cone = cone; }, material, 0.5);
  }
}

// A pyramid turns at once where its slip becomes fast enough. A nanometre a second from there the
// derivative is that of a slip 1 % slower, or faster, not the jump over the step of a difference.
TEST(InverseDerivative, IsOfOneSideWhereAPyramidBeginsToFollowItsSlip) {
  ModelBuilder b("block");
  b.base = BaseKind::floating;
  b.X_WRoot.p.z() = 0.0399;
  b.link(boxLink("block", 1.0, Vector3(0.1, 0.06, 0.04)));
  b.geometry(geometrySpec("block", Shape::box({0.1, 0.06, 0.04})));
  b.geometry(groundSpec(1.0));
  Scene s(b.build());
  s.contacts = std::make_shared<collision::SceneContacts>(s.model);
  const Vector3 way = Vector3(0.6, 0.8, 0.0);
  const auto tangent = [&](double speed) -> Vector3 {
    s.state.v.head<3>() = speed * way - Vector3(0.0, 0.0, 0.01);
    s.stages();
    return s.data->constraints.contact.contactsWithRows().at(0).R_WC.col(1);
  };
  double slow = 1e-6, fast = 1.0;
  ASSERT_LT(std::abs(tangent(slow).dot(way)), 0.9);
  ASSERT_GT(tangent(fast).dot(way), 0.99);
  while (fast - slow > 1e-9) {
    const double middle = 0.5 * (slow + fast);
    (std::abs(tangent(middle).dot(way)) > 0.99 ? fast : slow) = middle;
  }
  VectorX a(6);
  a << -1.0, 0.5, -9.81, 0.3, 1.0, 2.0;  // the ground holds it
  InverseDerivative derivative(s.model);
  const auto at = [&](double speed) {
    tangent(speed);
    EXPECT_EQ(derivative.compute(s.model, s.input, s.state, a, s.contacts.get(), *s.data),
              SolveStatus::converged);
    MatrixX G(6, 12);
    G << derivative.q(), derivative.v();
    return G;
  };
  for (const auto& [jump, beside] : {std::pair(slow, 0.99 * slow), std::pair(fast, 1.01 * fast)}) {
    const MatrixX expected = at(beside);
    EXPECT_APPROX(at(jump), expected, 0.03) << jump;
  }
}

TEST(InverseDerivative, OfSoftContactsInTheirMargin) {
  Material material;
  material.margin = 0.02;
  material.impedance.dMin = 1e-4, material.impedance.width = 0.05;
  expectContacts(
      closedForms(), [](Scene&) {}, material, 0.5);
}

TEST(InverseDerivative, OfContactsOfShapesWithoutAClosedForm) {
  expectContacts(
      {{Shape::box({0.1, 0.06, 0.04}), Ground::box},
       {Shape::capsule(0.04, 0.1), Ground::box},
       {Shape::ellipsoid({0.1, 0.06, 0.08}), Ground::plane},
       {Shape::ellipsoid({0.1, 0.06, 0.08}), Ground::tilting}},
      [](Scene&) {}, {}, 0.5, 1e-6);  // themselves differences
}

// They touch at two points or three, whose shares follow the angle between them. The one that does
// not move is the first of the pair, or the second.
TEST(InverseDerivative, OfCapsulesThatLieAlongside) {
  const Transform fixed{Matrix3::Identity(), {0.1, 0.2, 0.3}};
  Count count;
  for (const bool worldFirst : {true, false}) {
    for (const double angle : {0.0, 0.03, 0.08}) {
      Random random(7);
      ModelBuilder b("bar");
      b.link(emptyLink("world"));
      b.link(randomLink("bar", random));
      b.joint(jointSpec("free", JointType::floating, "world", "bar"));
      const auto add = [&](const char* link, const Transform& X) {
        b.geometry(geometrySpec(link, Shape::capsule(0.1, 0.4), 1.0, X));
      };
      if (worldFirst) add("world", fixed);
      add("bar", {});
      if (!worldFirst) add("world", fixed);
      Scene s(b.build());
      s.state.v = random.vector(6, 0.3);
      const Vector3 place = fixed.p + Vector3(0.1993, 0.01, 0.02);  // 0.7 mm deep or a little less
      const Quaternion turned = quaternionExp({angle, 0.0, 0.0});
      s.state.q << place, turned.w(), turned.x(), turned.y(), turned.z();
      s.contacts = std::make_shared<collision::SceneContacts>(s.model);
      s.input.controlled = allTrees(s.model);
      s.stages();
      EXPECT_GE(s.data->contacts.size(), 2);
      EXPECT_EQ(s.data->contacts.contacts[0].bodyA == 0, worldFirst);
      SCOPED_TRACE(testing::Message() << angle << worldFirst);
      expectDerivative(s, random.vector(6, 3.0), count, 1e-6);
    }
  }
  expectFewKinks(count);
}

// Of servos at their limit and within it.
TEST(InverseDerivative, OfServos) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    Random random(seed);
    Scene s(chain(6).build());
    for (Dof& dof : s.model.dofs)
      dof.servo = {.kp = random.uniform(1.0, 300.0),
                   .kd = random.uniform(0.0, 20.0),
                   .effort = random.uniform(2.0, 60.0),
                   .setPoint = random.uniform(-1.0, 1.0)};
    s.state = randomState(s.model, random);
    Count count;
    expectDerivative(s, random.vector(s.model.nv, 5.0), count);
    EXPECT_GT(count.compared, 6);
  }
}

}  // namespace
}  // namespace softgauss::test
