// SPDX-License-Identifier: Apache-2.0
/// Two meshes of triangles, both hollow, of which neither may count as its hull.

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_surfaces.hpp"
#include "tests/support/scene.hpp"
#include "tests/validation/shared.hpp"

namespace softgauss::test {
namespace {

using collision::SceneContacts;

constexpr double kBodyMass = 1.0;  ///< of each body [kg]

Transform at(const Vector3& p) { return {Matrix3::Identity(), p}; }
/// The z axis along y.
Matrix3 lying() { return Eigen::AngleAxisd(M_PI / 2, Vector3::UnitX()).toRotationMatrix(); }

ModelBuilder withFixed(ModelBuilder builder, const Shape& shape, const Transform& X_WG) {
  return builder.geometry(geometrySpec("world", shape, 0.8, X_WG));
}

/// A free body of triangles, with the inertia of a box about its centre of mass.
ModelBuilder hollowBody(const MeshPointer& mesh, const Vector3& halfExtents, const Transform& X_WB,
                        const Vector3& com = Vector3::Zero()) {
  ModelBuilder builder = freeBody(boxLink("body", kBodyMass, halfExtents, com));
  builder.X_WRoot = X_WB;
  return builder.geometry(geometrySpec("body", Shape::surface(mesh), 0.8));
}

struct Hollow : Scene {
  explicit Hollow(const ModelBuilder& builder) : Scene(builder.build()) {
    contacts = std::make_shared<SceneContacts>(model);
  }
  /// Upward force of the world on what moves [N].
  double carried() const {
    double sum = 0.0;
    const PyramidalContact& contact = data->constraints.contact;
    for (int i = 0; i < static_cast<int>(contact.contactsWithRows().size()); ++i) {
      const ContactRows& made = contact.contactsWithRows()[static_cast<std::size_t>(i)];
      sum += (made.bodyA == 0 ? 1.0 : made.bodyB == 0 ? -1.0 : 0.0) * contact.force(i).z();
    }
    return sum;
  }
};

}  // namespace

// A ring hangs in a clamp, the top of its hole on the clamp's floor. That is 4 cm wide: at its rims
// the hole is lower by 1.2 mm than at its top.
TEST(HollowPairs, ARingHangsInAClamp) {
  const double radius = 0.2, tube = 0.03, hole = radius - tube, top = 0.02;
  const Transform X_WC{Eigen::AngleAxisd(M_PI / 2, Vector3::UnitZ()).toRotationMatrix(),
                       Vector3(0, 0, 0.08)};
  Hollow s(withFixed(hollowBody(ringSurface(radius, tube, 60, 12), {0.2, 0.2, 0.03},
                                {lying(), Vector3(0, 0, top - hole + 0.003)}),
                     Shape::surface(clampSurface({0.2, 0.02, 0.1}, 0.04)), X_WC));
  s.steps(3000);
  EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_NEAR(s.state.q[2], top - std::sqrt(hole * hole - 0.02 * 0.02), 1e-3);
  EXPECT_SMALL(s.carried() / (kBodyMass * kGravity) - 1.0, 1e-3);
}

// A chain of links, each a ring through the next: the uppermost is fixed and carries all.
TEST(HollowPairs, LinksOfAChainHang) {
  const double radius = 0.1, tube = 0.02;
  const MeshPointer ring = ringSurface(radius, tube, 24, 12);
  constexpr int kLinks = 3;
  const double pitch = 2 * (radius - tube);
  ModelBuilder builder("chain");
  builder.geometry(geometrySpec("world", Shape::surface(ring), 0.8, {lying(), Vector3::Zero()}));
  const Matrix3 across = Eigen::AngleAxisd(M_PI / 2, Vector3::UnitZ()).toRotationMatrix() * lying();
  for (int i = 0; i < kLinks; ++i)
    builder.add(
        hollowBody(ring, {radius, radius, tube},
                   {i % 2 == 0 ? across : lying(), Vector3(0, 0, -(i + 1) * pitch + 0.002)}),
        "link" + std::to_string(i));
  // Of a step in parts the forces are those of its last part.
  builder.options.substepAngle = kInfinity;
  Hollow s(builder);
  s.steps(2000);
  const auto momentum = [&] {
    double sum = 0.0;
    for (int i = 0; i < kLinks; ++i) sum += kBodyMass * s.state.v[6 * i + 2];
    return sum;
  };
  const double before = momentum(), h = s.model.options.timestep;
  double impulse = 0.0;
  for (int k = 0; k < 500; ++k) {
    s.step();
    impulse += h * (s.carried() - kLinks * kBodyMass * kGravity);
    for (int i = 0; i < kLinks; ++i)
      ASSERT_NEAR(s.state.q[7 * i + 2], -(i + 1) * pitch, 4e-3) << "link " << i;
  }
  // They still swing: what is carried beyond their weight is the change of their momentum.
  EXPECT_SMALL((impulse - (momentum() - before)) / (500 * h * kLinks * kBodyMass * kGravity), 1e-6);
}

// A nut around a bar: it slides down, does not leave it, and lands on the plate.
TEST(HollowPairs, ANutSlidesDownABar) {
  const MeshPointer nut = washerSurface(0.06, 0.021, 0.02);
  for (const bool isBox : {true, false}) {
    Hollow s(
        withFixed(withFixed(hollowBody(nut, {0.06, 0.06, 0.02}, at({0, 0, 0.2})),
                            isBox ? Shape::box({0.02, 0.02, 0.3}) : Shape::cylinder(0.02, 0.3), {}),
                  Shape::box({0.2, 0.2, 0.05}), at({0, 0, -0.05})));
    s.steps(1500);
    EXPECT_NEAR(s.state.q[2], 0.02, 1e-3);
    EXPECT_SMALL(s.state.q.head<2>().norm(), 2e-3);
    EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), 1e-3);
  }
}

// Four legs stand on what is uneven; a rock between them does not lift the seat.
TEST(HollowPairs, AChairStandsOnItsFourLegs) {
  std::vector<BoxPart> parts{{{0.2, 0.2, 0.02}, {0, 0, 0.4}}};
  for (const double x : {-0.18, 0.18})
    for (const double y : {-0.18, 0.18}) parts.push_back({{0.02, 0.02, 0.2}, {x, y, 0.2}});
  const MeshPointer chair = boxesSurface(parts);
  const MeshPointer rock = gridMesh(40, 40, 0.05, 0.2, [](double x, double y) {
    return std::max(0.0, 0.3 - 3.0 * std::hypot(x, y));
  });
  const MeshPointer flat = gridMesh(4, 4, 0.5);
  for (const MeshPointer& ground : {flat, rock}) {
    Hollow s(withFixed(hollowBody(chair, {0.2, 0.2, 0.1}, at({0, 0, 0.002}), {0, 0, 0.3}),
                       Shape::surface(ground), {}));
    s.steps(1500);
    EXPECT_SMALL(s.state.q[2], 1e-3);
    EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), 1e-4);
    EXPECT_SMALL(s.carried() / (kBodyMass * kGravity) - 1.0, 1e-3);
    EXPECT_EQ(s.data->stats.contacts, 4);
  }
}

// Forty bodies of every kind, hollow ones among them, are dropped into a bin and stay there.
TEST(HollowPairs, ABinHoldsFortyBodies) {
  const double half = 0.4, wall = 0.02, high = 0.4;
  const MeshPointer bin = boxesSurface({{{half, half, wall}, {0, 0, -wall}},
                                        {{half, wall, high}, {0, half, high}},
                                        {{half, wall, high}, {0, -half, high}},
                                        {{wall, half, high}, {half, 0, high}},
                                        {{wall, half, high}, {-half, 0, high}}});
  const Shape shapes[] = {Shape::sphere(0.05), Shape::box({0.06, 0.04, 0.03}),
                          Shape::hull(ballSurface(0.05, 5, 8)), Shape::capsule(0.03, 0.05),
                          Shape::surface(washerSurface(0.06, 0.03, 0.02))};
  ModelBuilder builder("bin");
  builder.geometry(geometrySpec("world", Shape::surface(bin), 0.6));
  Random random(4);
  for (int i = 0; i < 40; ++i) {
    ModelBuilder one = freeBody(boxLink("body", 0.2, {0.05, 0.05, 0.04}));
    one.X_WRoot = {random.rotation(),
                   Vector3(0.2 * (i % 3 - 1), 0.2 * (i / 3 % 3 - 1), 0.15 + 0.16 * (i / 9))};
    one.geometry(geometrySpec("body", shapes[i % 5], 0.6));
    builder.add(one, "object" + std::to_string(i));
  }
  Hollow s(builder);
  s.steps(1500);
  for (int i = 0; i < 40; ++i) {
    const Vector3 p = s.state.q.segment<3>(7 * i);
    EXPECT_SMALL(p.head<2>().cwiseAbs().maxCoeff(), half) << "body " << i;
    EXPECT_GT(p.z(), 0.0) << "body " << i;
    EXPECT_LT(p.z(), 1.0) << "body " << i;
  }
  EXPECT_SMALL(s.carried() / (40 * 0.2 * kGravity) - 1.0, 0.2);
}

TEST(HollowPairs, GiveTheSameBits) {
  const auto end = [] {
    const MeshPointer ring = ringSurface(0.1, 0.02, 24, 12);
    Hollow s(withFixed(hollowBody(ring, {0.1, 0.1, 0.02}, at({0.02, 0.01, 0.2})),
                       Shape::surface(clampSurface({0.2, 0.1, 0.1}, 0.05)), {}));
    s.state.v << 0.5, 0.1, 0.0, 2.0, -1.0, 1.0;
    s.steps(500);
    return hash(s.state);
  };
  EXPECT_EQ(end(), end());
}

}  // namespace softgauss::test
