// SPDX-License-Identifier: Apache-2.0
/// More numbers of an independent implementation (MuJoCo 2.2.2, solver tolerance 0, h = 2 ms,
/// defaults): elliptic cones, a connection, a weld, a coupling.
///
/// Since its 3.7 that implementation takes J̇ v off the references of connections and welds, and
/// since its 3.0 it weighs and scales the rotation of welds otherwise. So does this engine; the
/// tests undo that in the rows, and then everything else has to agree.

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"
#include "tests/validation/shared.hpp"

namespace softgauss::test {
namespace {

// As many digits as were recorded.

/// A sphere of 10 cm and 1 kg that slides and sinks into the ground.
Scene slidingSphere(double impedanceRatio, const Material& material = {}) {
  ModelBuilder builder = sphereOnPlane(0.1, 1.0, 1.0);
  builder.options.tolerance = 1e-15;
  builder.options.cone = Cone::elliptic;
  builder.options.impedanceRatio = impedanceRatio;
  builder.options.constraintModel = ConstraintModel::mujoco;  // without J̇ v of contacts
  builder.options.integrator = Integrator::semiImplicitEuler;
  Model model = builder.build();
  for (Geometry& g : model.geometries) g.material = material;
  Scene s(std::move(model), std::make_shared<SampleContacts>());
  s.state.q << 0, 0, 0.0995, 1, 0, 0, 0;
  s.state.v << 0.1, 0, -0.05, 0, 0, 0;
  s.stages();
  s.forward();
  return s;
}

/// The size of the force along the direction of sliding, whichever tangent that is.
double slidingForce(const EllipticContact& rows) { return std::hypot(rows.f[1], rows.f[2]); }

TEST(SlidingSphereOnCone, RowsAreThoseOfTheReference) {
  Scene s = slidingSphere(1.0);
  const EllipticContact& rows = s.data->constraints.ellipticContact;
  ASSERT_EQ(rows.rowCount(), 3);
  EXPECT_SMALL(1.0 / rows.cone(0).D - 0.0810810810811, 1e-12);
  EXPECT_EQ(rows.cone(0).mu, 1.0);
  EXPECT_SMALL(rows.reference[0] - 6.54432132964, 1e-11);
  EXPECT_SMALL(rows.f[0] - 15.1277472299, 1e-10);
  EXPECT_SMALL(slidingForce(rows) - 2.94970730975, kDigits12);
  EXPECT_SMALL(s.data->forward.a[0] + 2.94970730974903, kDigits15);
}

TEST(SlidingSphereOnCone, IsWhereTheReferenceIsAfter100Steps) {
  Scene s = slidingSphere(1.0);
  s.steps(100);
  EXPECT_SMALL(s.state.q[0] - 0.0144840066806888, kDigits15);
  EXPECT_SMALL(s.state.v[0] - 0.0713258119260177, kDigits15);
}

TEST(SlidingSphereOnCone, WithHarderFrictionToo) {
  Scene s = slidingSphere(10.0);
  const EllipticContact& rows = s.data->constraints.ellipticContact;
  EXPECT_SMALL(rows.cone(0).mu - 0.316227766017, 1e-12);
  const double tangential = rows.cone(0).mu * rows.cone(0).mu / rows.cone(0).D;  // μ₁ = 1
  EXPECT_SMALL(tangential - 0.00810810810811, 1e-13);
  EXPECT_SMALL(slidingForce(rows) - 3.01128399197, kDigits12);
  s.steps(100);
  EXPECT_SMALL(s.state.q[0] - 0.0144792172115827, kDigits15);
}

TEST(SlidingSphereOnCone, WithRollingFrictionToo) {
  Material material;
  material.condim = 6;
  Scene s = slidingSphere(1.0, material);
  const EllipticContact& rows = s.data->constraints.ellipticContact;
  ASSERT_EQ(rows.rowCount(), 6);
  const EllipticCone& cone = rows.cone(0);
  const double expected[] = {0.0810810810811, 0.0810810810811, 3243.24324324, 8108108.10811,
                             8108108.10811};
  for (int k = 0; k < 5; ++k) {
    const double R = cone.mu * cone.mu / (cone.D * cone.friction[k] * cone.friction[k]);
    EXPECT_SMALL(R / expected[k] - 1.0, 1e-12);
  }
  EXPECT_SMALL(std::hypot(rows.f[4], rows.f[5]) / 9.07210880434e-06 - 1.0, 1e-10);
}

/// A free box of half extents (0.1, 0.2, 0.3) and 2 kg, tied to the world by `tie` where it starts.
Scene tiedBox(const std::function<void(ModelBuilder&)>& tie) {
  ModelBuilder builder = freeBody(boxLink("box", 2.0, {0.1, 0.2, 0.3}));
  builder.options.tolerance = 1e-15;
  builder.options.integrator = Integrator::semiImplicitEuler;  // ties of (3.1) as they are
  tie(builder);
  Scene s(builder.build());
  s.state.v << 0.1, 0.2, 0.3, 0.4, 0.5, 0.6;
  return s;
}

TEST(ConnectedBox, IsThatOfTheReference) {
  Scene s = tiedBox([](ModelBuilder& builder) {
    ConnectSpec spec;
    spec.linkA = "box";
    spec.linkB = "world";
    spec.p_LAP = Vector3(0, 0, 0.3);
    spec.p_LBP = Vector3(0, 0, 1.3);
    builder.connect(spec);
  });
  s.state.q << 0.01, 0.002, 1, 1, 0, 0, 0;
  s.stages();
  ConnectionRows& rows = s.data->constraints.connection;
  ASSERT_EQ(rows.rowCount(), 3);
  // J̇ v = ω × (ω × p)
  const Vector3 w = s.state.v.tail<3>(), bias = w.cross(w.cross(Vector3(0, 0, 0.3)));
  const double reference[] = {-52.6315789474, -13.6842105263, -31.5789473684};
  for (int i = 0; i < 3; ++i) {
    rows.reference[i] += bias[i];
    EXPECT_SMALL(1.0 / rows.D[i] - 0.0263157894737, 1e-13);
    EXPECT_SMALL(rows.reference[i] - reference[i], 1e-10);
  }
  s.forward();
  const double force[] = {-28.0197924264, -8.72302716688, -41.361};
  for (int i = 0; i < 3; ++i) EXPECT_SMALL(rows.f[i] - force[i], 1e-10);
  VectorX a(6);
  a << -14.0098962131837, -4.36151358344114, -30.4905, 30.3104786545925, -126.281065918654, 0.12;
  EXPECT_APPROX(s.data->forward.a, a, kDigits15);
}

TEST(WeldedBox, IsThatOfTheReference) {
  Scene s = tiedBox([](ModelBuilder& builder) {
    WeldSpec spec;
    spec.linkA = "box";
    spec.linkB = "world";
    spec.X_LAF.p = Vector3(0, 0, -1);  // the frame is at the world's origin
    spec.torqueScale = 0.5;
    builder.weld(spec);
  });
  const double e = 0.002;
  s.state.q << 1e-4, 2e-4, 1, std::sqrt(1.0 - e * e), e, 0, 0;
  s.stages();
  WeldRows& rows = s.data->constraints.weld;
  ASSERT_EQ(rows.rowCount(), 6);
  EXPECT_SMALL(1.0 / rows.D[0] - 0.0263157894737, 1e-13);
  EXPECT_SMALL(1.0 / rows.D[3] - 18.8461538462 * 0.05 / 0.95, 1e-10);

  // Without J̇ v, the rotation as heavy as the translation, its distance not scaled.
  const Matrix3 R =
      Quaternion(s.state.q[3], s.state.q[4], s.state.q[5], s.state.q[6]).toRotationMatrix();
  const Vector3 w_W = R * s.state.v.tail<3>(), arm = R * Vector3(0, 0, -1);
  const Vector3 bias = w_W.cross(w_W.cross(arm));
  const Vector3 w_B = s.state.v.tail<3>();
  for (int i = 0; i < 3; ++i) rows.reference[i] += bias[i];
  const double kd = 0.95 / std::pow(0.95 * 0.02, 2), b = 2.0 / (0.95 * 0.02);
  // ē̇ = ½ (e₀ ω + ē × ω), in the frame that turns.
  const Vector3 rate = 0.5 * (std::sqrt(1.0 - e * e) * w_B + Vector3(e, 0, 0).cross(w_B));
  for (int i = 0; i < 3; ++i) {
    rows.reference[3 + i] = -b * 0.5 * rate[i] - kd * (i == 0 ? e : 0.0);
    rows.D[3 + i] = rows.D[0];
  }
  s.forward();
  const double force[] = {-9.99888368522, -14.1692535635, -41.2136760503,
                          34.1549371145,  -52.488836009,  -8.42527133919};
  for (int i = 0; i < 6; ++i) EXPECT_SMALL(rows.f[i] - force[i], 1e-9) << i;
}

TEST(CoupledHinges, AreThoseOfTheReference) {
  ModelBuilder builder("hinges");
  builder.base = BaseKind::fixed;
  builder.options.tolerance = 1e-15;
  builder.options.integrator = Integrator::semiImplicitEuler;
  builder.link(emptyLink("world"));
  std::string parent = "world";
  for (const std::string name : {"a", "b"}) {
    builder.link(sphereLink(name, 1.0, 0.05, {0, 0, -0.5}));
    builder.joint(jointSpec(name + "_joint", JointType::revolute, parent, name,
                            {Matrix3::Identity(), Vector3(0, 0, name == "a" ? 0.0 : -1.0)},
                            Vector3::UnitY()));
    parent = name;
  }
  CouplingSpec spec;
  spec.follower = "b_joint";
  spec.leader = "a_joint";
  spec.polynomial = {0.1, -2.0, 0.3, 0.0, 0.0};
  builder.couple(spec);
  builder.options.constraintModel = ConstraintModel::mujoco;  // without p″
  Scene s(builder.build());
  s.state.q << 0.2, -0.25;
  s.state.v << 1, -1;
  s.stages();
  s.forward();
  const CouplingRows& row = s.data->constraints.coupling;
  ASSERT_EQ(row.rowCount(), 1);
  EXPECT_SMALL(1.0 / row.D[0] - 2.26394488902, 2e-12 * 2.3);
  EXPECT_SMALL(row.reference[0] + 192.631578947, 1e-9);
  EXPECT_SMALL(row.f[0] + 21.1726904418, 1e-10);
  EXPECT_SMALL(s.data->forward.a[0] - 58.8645718297806, 1e-11);
  EXPECT_SMALL(s.data->forward.a[1] + 255.36316967495, 1e-10);
}

}  // namespace
}  // namespace softgauss::test
