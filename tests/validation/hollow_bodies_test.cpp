// SPDX-License-Identifier: Apache-2.0
/// Bodies with hollows: what their hulls could not do.

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/model/closed_surface.hpp"
#include "softgauss/engine/model/mass_properties.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_surfaces.hpp"
#include "tests/support/scene.hpp"
#include "tests/validation/shared.hpp"

namespace softgauss::test {
namespace {

Scene withContacts(const ModelBuilder& builder) {
  Scene s(builder.build());
  s.contacts = std::make_shared<collision::SceneContacts>(s.model);
  return s;
}

/// Force on the moving bodies.
Vector3 carried(const Scene& s) {
  Vector3 sum = Vector3::Zero();
  const PyramidalContact& contact = s.data->constraints.contact;
  for (int i = 0; i < static_cast<int>(contact.contactsWithRows().size()); ++i)
    sum += (contact.contactsWithRows()[static_cast<std::size_t>(i)].bodyA == 0 ? 1.0 : -1.0) *
           contact.force(i);
  return sum;
}

/// A horizontal bar along x through the origin, fixed to the world.
GeometrySpec bar(const Shape& shape, double friction = 0.8) {
  GeometrySpec g = geometrySpec("world", shape, friction);
  g.X_LG.R = Eigen::AngleAxisd(M_PI / 2, Vector3::UnitY()).toRotationMatrix();
  return g;
}

}  // namespace

// A ring hangs on a peg, which carries its weight.
TEST(HollowBodies, ARingHangsOnAPeg) {
  const double radius = 0.1, tube = 0.015, peg = 0.02;
  for (const Shape& shape : {Shape::capsule(peg, 0.1), Shape::cylinder(peg, 0.1)}) {
    ModelBuilder builder = freeBody(boxLink("ring", 0.5, {radius, radius, tube}));
    // The ring's own axis lies along the peg; it starts a little above its rest.
    builder.X_WRoot = {Eigen::AngleAxisd(M_PI / 2, Vector3::UnitY()).toRotationMatrix(),
                       Vector3(0.005, 0.0, -(radius - tube - peg) + 0.002)};
    builder.geometry(geometrySpec("ring", Shape::surface(ringSurface(radius, tube, 48, 16)), 0.8));
    builder.geometry(bar(shape));
    Scene s = withContacts(builder);
    s.steps(5000);
    EXPECT_SMALL(s.state.q[2] + radius - tube - peg, 1e-3) << "hangs below the peg";
    EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), 2e-2);
    EXPECT_SMALL((carried(s) - Vector3(0, 0, 0.5 * kGravity)).norm() / (0.5 * kGravity), 0.05);
  }
}

// A mug hangs by its handle for a minute.
TEST(HollowBodies, AMugHangsByItsHandle) {
  ModelBuilder builder = freeBody(boxLink("mug", 0.3, {0.04, 0.04, 0.05}, {0.0, 0.0, -0.075}));
  // The handle is a ring about x, the cup hangs below it.
  builder.geometry(geometrySpec(
      "mug", Shape::surface(ringSurface(0.025, 0.006, 32, 12)), 0.8,
      {Eigen::AngleAxisd(M_PI / 2, Vector3::UnitY()).toRotationMatrix(), Vector3::Zero()}));
  builder.geometry(geometrySpec("mug", Shape::cylinder(0.04, 0.05), 0.8,
                                {Matrix3::Identity(), Vector3(0, 0, -0.082)}));
  builder.X_WRoot.p = Vector3(0, 0, -(0.025 - 0.006 - 0.004));
  builder.geometry(bar(Shape::capsule(0.004, 0.05)));
  Scene s = withContacts(builder);
  s.steps(5000);
  const Vector3 settled = s.state.q.head<3>();
  s.steps(25000);
  EXPECT_SMALL((s.state.q.head<3>() - settled).norm(), 1e-3);
  EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), 1e-2);
  EXPECT_SMALL((carried(s) - Vector3(0, 0, 0.3 * kGravity)).norm() / (0.3 * kGravity), 0.05);
}

// A mug of one mesh, hollow and with a handle, hangs by it on a peg of triangles for a minute, its
// centre of mass below the peg. Soft, it creeps by 3 microns; near-rigid it rocks on one or two
// points of the triangles and creeps by 2 microns a second (docs/limits.md).
void aMugOfOneMeshHangs(bool rigid) {
  const double radius = 0.04, peg = 0.004;
  const MeshPointer mesh = mugSurface(radius, 0.05, 0.004);
  ASSERT_FALSE(surfaceDefects(*mesh).any());
  const MassProperties solid = solidOf(Shape::hull(mesh), 2400.0);  // stoneware
  LinkSpec mug;
  mug.name = "mug";
  mug.mass = solid.mass;
  mug.com = solid.com;
  mug.I_Lcm = solid.I_Gcm;
  ModelBuilder builder = freeBody(mug);
  builder.geometry(geometrySpec("mug", Shape::surface(mesh), 0.8));
  // The handle is up, and its inside half a millimetre above the peg.
  const double inside = radius + kMugHandleReach - kMugHandleRadius;
  builder.X_WRoot = {Eigen::AngleAxisd(-M_PI / 2, Vector3::UnitY()).toRotationMatrix(),
                     Vector3(0, 0, peg - inside + 5e-4)};
  GeometrySpec rod = geometrySpec("world", Shape::surface(cylinderSurface(peg, 0.05, 24)), 0.8);
  rod.X_LG.R = Eigen::AngleAxisd(M_PI / 2, Vector3::UnitX()).toRotationMatrix();
  builder.geometry(rod);
  if (!rigid) builder.options.mechanisms.remove(Mechanism::nearRigid);
  Scene s = withContacts(builder);
  s.steps(12000);  // it swings out, on a peg that takes little of it
  const Vector3 settled = s.state.q.head<3>();
  s.steps(30000);
  EXPECT_SMALL((s.state.q.head<3>() - settled).norm(), rigid ? 1e-3 : 1e-4);
  EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), rigid ? 1e-2 : 1e-3);
  EXPECT_SMALL((carried(s) - Vector3(0, 0, mug.mass * kGravity)).norm() / (mug.mass * kGravity),
               0.01);
  const Vector3 centre = s.data->kinematics.X_WB[1] * mug.com;
  EXPECT_SMALL(centre.head<2>().norm(), peg) << "hangs below the peg";
  EXPECT_LT(centre.z(), -0.05);
}

TEST(HollowBodies, AMugOfOneMeshHangsByItsHandle) {
  aMugOfOneMeshHangs(true);
  aMugOfOneMeshHangs(false);
}

// A chair of one mesh stands on its four legs, on a plane and on a box.
TEST(HollowBodies, AChairStandsOnItsLegs) {
  std::vector<BoxPart> parts = {{{0.2, 0.2, 0.02}, {0, 0, 0.2}},
                                {{0.02, 0.2, 0.2}, {-0.18, 0, 0.4}}};
  for (const double x : {-0.18, 0.18})
    for (const double y : {-0.18, 0.18}) parts.push_back({{0.02, 0.02, 0.1}, {x, y, 0.085}});
  const MeshPointer chair = boxesSurface(parts);
  for (const bool onBox : {false, true}) {
    ModelBuilder builder = freeBody(boxLink("chair", 4.0, {0.2, 0.2, 0.2}, {-0.02, 0, 0.25}));
    builder.X_WRoot.p.z() = 0.02;
    builder.geometry(geometrySpec("chair", Shape::surface(chair), 0.7));
    builder.geometry(onBox ? geometrySpec("world", Shape::box({1, 1, 0.5}), 0.7,
                                          {Matrix3::Identity(), Vector3(0, 0, -0.5)})
                           : groundSpec(0.7));
    Scene s = withContacts(builder);
    s.steps(1500);
    EXPECT_SMALL(s.state.q[2] - 0.015, 1e-3) << onBox;
    // Which four of sixteen corners carry changes with the depths: it rocks by microns, on a box at
    // up to 2.4 mm/s.
    EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), 3e-3) << onBox;
    Vector3 mean = Vector3::Zero();
    for (int i = 0; i < 100; ++i) {
      s.step();
      mean += 0.01 * carried(s);
    }
    EXPECT_SMALL((mean - Vector3(0, 0, 4.0 * kGravity)).norm() / (4.0 * kGravity), 0.01);
  }
}

// Forty bodies fall into a bin and stay there; of its hull they would lie on the lid.
TEST(HollowBodies, ABinHoldsForty) {
  const double half = 0.4, wall = 0.02, height = 0.4;
  std::vector<BoxPart> parts = {{{half, half, wall}, {0, 0, -wall}}};
  for (const double side : {-1.0, 1.0}) {
    parts.push_back({{wall, half, height}, {side * (half - wall), 0, height}});
    parts.push_back({{half, wall, height}, {0, side * (half - wall), height}});
  }
  ModelBuilder builder("bin");
  builder.geometry(geometrySpec("world", Shape::surface(boxesSurface(parts)), 0.5));
  for (int i = 0; i < 40; ++i) {
    Random random(static_cast<std::uint64_t>(i));
    ModelBuilder one("one");
    one.base = BaseKind::floating;
    one.X_WRoot = {random.rotation(), Vector3(-0.21 + 0.14 * (i % 4), -0.21 + 0.14 * (i / 4 % 4),
                                              0.15 + 0.16 * (i / 16))};
    one.link(boxLink("body", 0.3, {0.05, 0.04, 0.03}));
    const Shape shapes[] = {Shape::box({0.05, 0.04, 0.03}), Shape::sphere(0.05),
                            Shape::capsule(0.03, 0.03), Shape::cylinder(0.04, 0.04),
                            Shape::hull(ballSurface(0.05, 5, 7))};
    one.geometry(geometrySpec("body", shapes[i % 5], 0.5));
    builder.add(one, "object" + std::to_string(i));
  }
  Scene s = withContacts(builder);
  s.steps(1000);
  for (const Body& body : s.model.bodies) {
    if (body.joint != JointKind::floating) continue;
    const Vector3 p = s.state.q.segment<3>(body.q);
    EXPECT_LT(std::max(std::abs(p.x()), std::abs(p.y())), half - 2 * wall);
    EXPECT_GT(p.z(), 0.015);
    EXPECT_LT(p.z(), 2 * height);
  }
}

}  // namespace softgauss::test
