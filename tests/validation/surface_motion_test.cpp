// SPDX-License-Identifier: Apache-2.0
/// What moves on surfaces of triangles, with physical answers.

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/io/height_field.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/sample_surfaces.hpp"
#include "tests/support/scene.hpp"
#include "tests/validation/shared.hpp"

namespace softgauss::test {
namespace {

using collision::SceneContacts;

/// One body, started somewhere, on something fixed.
struct OnSurface : Scene {
  explicit OnSurface(const ModelBuilder& builder) : Scene(builder.build()) {
    contacts = std::make_shared<SceneContacts>(model);
  }
};

ModelBuilder bodyOn(const LinkSpec& link, const Shape& shape, const Shape& ground, double friction,
                    const Transform& X_WB, const Matrix3& R_WGround = Matrix3::Identity()) {
  ModelBuilder builder = freeBody(link);
  builder.X_WRoot = X_WB;
  GeometrySpec fixed = geometrySpec("world", ground, friction);
  fixed.X_LG.R = R_WGround;
  return builder.geometry(geometrySpec(link.name, shape, friction)).geometry(fixed);
}

ModelBuilder ballOn(const Shape& ground, const Vector3& p) {
  return bodyOn(sphereLink("body", 1.0, kRadius), Shape::sphere(kRadius), ground, 1.0,
                {Matrix3::Identity(), p});
}

}  // namespace

// 1,000 triangles of one plane, their inner corners moved about, so that the ball crosses edges at
// all angles. It rolls at 1 m/s for 8 s.
TEST(SurfaceMotion, BallRollsStraightOverCoplanarTriangles) {
  const MeshPointer mesh = gridMesh(100, 5, 0.1, 0.3);
  ASSERT_EQ(mesh->triangles.size(), 1000u);
  OnSurface s(ballOn(Shape::surface(mesh), {-4.5, 0.013, kRadius}));
  OnSurface plane(ballOn(Shape::plane(), {-4.5, 0.013, kRadius}));
  for (Scene* scene : {static_cast<Scene*>(&s), static_cast<Scene*>(&plane)}) {
    scene->state.v[0] = 1.0;
    scene->state.v[4] = 1.0 / kRadius;
  }
  double highest = 0.0, lowest = 1.0;
  for (int i = 0; i < 4000; ++i) {
    s.step();
    plane.step();
    if (i < 500) continue;  // until it has settled
    ASSERT_EQ(s.data->stats.contacts, 1) << i;
    highest = std::max(highest, s.state.q[2]);
    lowest = std::min(lowest, s.state.q[2]);
  }
  EXPECT_GT(s.state.q[0], 3.4);
  EXPECT_SMALL(s.state.q[1] - 0.013, 1e-6);
  EXPECT_SMALL(s.state.v[0] / 1.0 - 1.0, 1e-3);
  // There are no edges: its height is that of one contact, to rounding.
  EXPECT_SMALL(highest - lowest, 1e-9);
  EXPECT_SMALL((s.state.q - plane.state.q).head<3>().norm(), 1e-4);  // of 8 m
}

TEST(SurfaceMotion, BoxSlidesOnTrianglesAsOnAPlane) {
  const Vector3 half(0.11, 0.07, 0.05);
  const auto slide = [&](const Shape& ground, double yaw = 0.3) {
    const Transform start = {Eigen::AngleAxisd(yaw, Vector3::UnitZ()).toRotationMatrix(),
                             Vector3(-0.5, 0.03, 0.0499)};
    OnSurface s(bodyOn(boxLink("body", 2.0, half), Shape::box(half), ground, 0.5, start));
    s.state.v[0] = 1.5;
    s.steps(1000);
    EXPECT_EQ(s.data->stats.contacts, 4);
    return s.state;
  };
  const State onPlane = slide(Shape::plane());
  const State onHull = slide(Shape::hull(gridMesh(4, 2, 0.4)));
  // v²/(2 μ g) = 0.229 m, less what the softness of the first impact takes.
  EXPECT_NEAR(onPlane.q[0] + 0.5, 1.5 * 1.5 / (2 * 0.5 * kGravity), 0.02);
  for (const double cell : {0.2, 0.05, 0.02}) {
    const int n = static_cast<int>(1.6 / cell), m = static_cast<int>(0.6 / cell) + 1;
    const State onTriangles = slide(Shape::surface(gridMesh(n, m, cell, 0.3)));
    EXPECT_SMALL((onTriangles.q - onHull.q).cwiseAbs().maxCoeff(), 1e-6) << "cell " << cell;
  }
  // How a corner moves (4.10) counts on a plane and not on a mesh, so that the box hops at other
  // instants: 0.1 mm of 0.23 m, in the median of its directions.
  std::vector<double> apart;
  for (int i = 0; i < 24; ++i) {
    const double yaw = 0.1 + 0.05 * i;
    const State plane = slide(Shape::plane(), yaw);
    const State surface = slide(Shape::surface(gridMesh(8, 4, 0.2, 0.3)), yaw);
    apart.push_back((surface.q - plane.q).head<3>().norm());
  }
  std::nth_element(apart.begin(), apart.begin() + 12, apart.end());
  EXPECT_SMALL(apart[12], 1e-4);
}

// A ball that rolls without sliding in a bowl of radius R swings with
//   T = 2π √(7 (R − r)/(5 g)) (1 + θ²/16),
// θ the amplitude.
TEST(SurfaceMotion, BallInABowlHasThePeriodOfTheBowl) {
  const double R = 1.0, amplitude = 0.3;
  OnSurface s(
      ballOn(Shape::surface(bowlMesh(R, 180, 240)),
             {(R - kRadius) * std::sin(amplitude), 0.0, -(R - kRadius) * std::cos(amplitude)}));
  const double h = s.model.options.timestep;
  std::vector<double> crossings;
  double before = s.state.q[0];
  for (int i = 0; i < 3000 && crossings.size() < 5; ++i) {
    s.step();
    const double now = s.state.q[0];
    if (before * now < 0.0) crossings.push_back(h * (i + before / (before - now)));
    before = now;
  }
  ASSERT_EQ(crossings.size(), 5u);
  const double period = (crossings[4] - crossings[0]) / 2.0;
  const double predicted =
      2 * M_PI * std::sqrt(7 * (R - kRadius) / (5 * kGravity)) * (1 + amplitude * amplitude / 16);
  EXPECT_SMALL(period / predicted - 1.0, 0.01);
  EXPECT_SMALL(s.state.q[1], 1e-3);
}

// Walls of 45° carry m g/√2 each, normal to themselves.
TEST(SurfaceMotion, CubeInAGrooveRestsByStatics) {
  const Vector3 half(0.1, 0.1, 0.1);
  for (const double cell : {1.0, 0.03}) {
    ModelBuilder builder = bodyOn(boxLink("body", 3.0, half), Shape::box(half),
                                  Shape::surface(grooveMesh(M_PI / 4, 0.6, 0.8, cell)), 0.0,
                                  {Eigen::AngleAxisd(M_PI / 4, Vector3::UnitY()).toRotationMatrix(),
                                   Vector3(0, 0.003, std::sqrt(2.0) * 0.1)});
    OnSurface s(builder);
    s.steps(2000);
    EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), 1e-9);
    const PyramidalContact& contact = s.data->constraints.contact;
    Vector3 left = Vector3::Zero(), right = Vector3::Zero();
    for (int i = 0; i < static_cast<int>(contact.contactsWithRows().size()); ++i) {
      const Vector3 f = contact.force(i);
      (f.x() > 0.0 ? left : right) += f;
    }
    const double load = 3.0 * kGravity / 2;
    EXPECT_EQ(contact.contactsWithRows().size(), 8u) << "cell " << cell;
    EXPECT_SMALL(left.norm() / (std::sqrt(2.0) * load) - 1.0, 1e-6);
    EXPECT_SMALL(right.norm() / (std::sqrt(2.0) * load) - 1.0, 1e-6);
    EXPECT_SMALL((left + right).cwiseAbs().head<2>().maxCoeff(), 1e-6);
    EXPECT_SMALL(s.state.q[0], 1e-6);
  }
}

// A mesh that is convex is its hull: bodies thrown on it move alike for a second.
TEST(SurfaceMotion, OnAConvexMeshIsThatOnItsHull) {
  const MeshPointer table = boxSurface({0.5, 0.4, 0.1}, 5), boulder = ballSurface(0.5, 9, 12);
  const Vector3 half(0.1, 0.07, 0.05);
  const Shape shapes[] = {Shape::box(half), Shape::sphere(0.1), Shape::capsule(0.05, 0.1),
                          Shape::hull(ballSurface(0.1, 4, 6))};
  for (const MeshPointer& ground : {table, boulder})
    for (const Shape& shape : shapes) {
      // Where its side crosses an edge, the hull may have one point twice.
      if (ground == boulder && shape.kind == ShapeKind::capsule) continue;
      SCOPED_TRACE(testing::Message() << ground->file << ", kind " << static_cast<int>(shape.kind));
      std::vector<VectorX> ends;
      for (const Shape& fixed : {Shape::hull(ground), Shape::surface(ground)}) {
        OnSurface s(
            bodyOn(boxLink("body", 1.0, half), shape, fixed, 0.6,
                   {Eigen::AngleAxisd(0.4, Vector3(1, 2, 3).normalized()).toRotationMatrix(),
                    Vector3(0.1, 0.05, ground == table ? 0.25 : 0.62)}));
        // Which points of a face begin before they touch differs between the two.
        s.model.options.mechanisms.remove(Mechanism::nearRigid);
        // At 0.18 m/s and more a body meets an edge of the boulder along which the directions of an
        // edge and of a face separate alike, to 1e-9 m; hull and mesh choose differently there.
        s.state.v << 0.15, 0.1, 0.0, 0.5, -0.3, 0.8;
        int touching = 0;
        for (int i = 0; i < 500; ++i) {
          s.step();
          touching += s.data->stats.contacts > 0;
        }
        EXPECT_GT(touching, 20);
        ends.push_back(s.state.q);
      }
      EXPECT_SMALL((ends[1] - ends[0]).cwiseAbs().maxCoeff(), 1e-6);
    }
}

// A landscape of one slope: a ball rolls down with 5/7 g sin θ.
TEST(SurfaceMotion, BallRollsDownALandscape) {
  const double slope = 0.2;
  io::Heights heights{21, 41, {}};
  for (int row = 0; row < heights.rows; ++row)
    for (int column = 0; column < heights.columns; ++column)
      heights.values.push_back(-0.1 * column * std::tan(slope));
  const auto mesh = std::make_shared<const Mesh>(io::heightFieldMesh(heights, 4.0, 2.0, 1.0, 1.0));
  const Vector3 n(std::sin(slope), 0.0, std::cos(slope));
  const Vector3 start = Vector3(-1.5, 0.013, -0.5 * std::tan(slope)) + kRadius * n;
  OnSurface s(ballOn(Shape::surface(mesh), start));
  s.steps(250);
  const double first = s.state.v.head<3>().norm();
  s.steps(250);
  const double acceleration = (s.state.v.head<3>().norm() - first) / 0.5;
  EXPECT_SMALL(acceleration / (5.0 / 7.0 * kGravity * std::sin(slope)) - 1.0,
               2e-3);  // soft friction creeps
  EXPECT_SMALL(s.state.q[1] - 0.013, 1e-6);
}

// A body on four feet stands on bumps: it comes to rest, and the ground carries its weight.
TEST(SurfaceMotion, FourFeetStandOnALandscape) {
  const auto bumps = gridMesh(60, 60, 0.05, 0.2, [](double x, double y) {
    return 0.03 * std::sin(4.0 * x) * std::cos(3.0 * y);
  });
  for (const bool roundFeet : {true, false}) {
    ModelBuilder builder = freeBody(boxLink("body", 8.0, {0.3, 0.2, 0.05}));
    builder.X_WRoot.p = Vector3(0.1, -0.05, 0.40);
    builder.geometry(geometrySpec("world", Shape::surface(bumps), 0.9));
    for (const double x : {-0.25, 0.25})
      for (const double y : {-0.18, 0.18})
        builder.geometry(
            geometrySpec("body", roundFeet ? Shape::sphere(0.03) : Shape::box({0.03, 0.02, 0.03}),
                         0.9, {Matrix3::Identity(), Vector3(x, y, -0.3)}));
    OnSurface s(builder);
    s.steps(1500);
    const Vector3 settled = s.state.q.head<3>();
    s.steps(1000);
    // On slopes of a tenth soft friction creeps.
    EXPECT_SMALL(s.state.v.cwiseAbs().maxCoeff(), 1e-3);
    EXPECT_SMALL((s.state.q.head<3>() - settled).norm(), 2e-3);
    EXPECT_GT(s.state.q[2], 0.25);
    Vector3 carried = Vector3::Zero();
    const PyramidalContact& contact = s.data->constraints.contact;
    for (int i = 0; i < static_cast<int>(contact.contactsWithRows().size()); ++i) {
      const ContactRows& made = contact.contactsWithRows()[static_cast<std::size_t>(i)];
      carried += (made.bodyA == 0 ? 1.0 : -1.0) * contact.force(i);
    }
    EXPECT_SMALL((carried - Vector3(0, 0, 8.0 * kGravity)).norm() / (8.0 * kGravity), 1e-3);
  }
}

TEST(SurfaceMotion, GivesTheSameBits) {
  const auto end = [] {
    const Vector3 half(0.1, 0.07, 0.05);
    OnSurface s(bodyOn(boxLink("body", 1.0, half), Shape::box(half),
                       Shape::surface(gridMesh(40, 40, 0.05, 0.2,
                                               [](double x, double y) {
                                                 return 0.05 * std::sin(3 * x) * std::cos(4 * y);
                                               })),
                       0.6, {Matrix3::Identity(), Vector3(0, 0, 0.3)}));
    s.state.v << 0.5, 0.1, 0.0, 2.0, -1.0, 1.0;
    s.steps(500);
    return hash(s.state);
  };
  EXPECT_EQ(end(), end());
}

}  // namespace softgauss::test
