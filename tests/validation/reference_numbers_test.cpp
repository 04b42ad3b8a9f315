// SPDX-License-Identifier: Apache-2.0
/// Numbers that an independent implementation of the same contact model gives (MuJoCo 2.2.2, solver
/// tolerance 0, h = 2 ms, defaults), and the rows behind them.

#include "tests/support/matchers.hpp"
#include "tests/support/reference_solver.hpp"
#include "tests/support/scene.hpp"
#include "tests/validation/shared.hpp"

namespace softgauss::test {
namespace {

// As many digits as were recorded.

/// A sphere of 10 cm and 1 kg that slides and sinks into the ground.
Scene slidingSphere() {
  ModelBuilder builder = sphereOnPlane(0.1, 1.0, 1.0);
  builder.options.tolerance = 1e-15;
  builder.options.constraintModel = ConstraintModel::mujoco;  // without J̇ v of contacts
  builder.options.integrator = Integrator::semiImplicitEuler;
  Scene s(builder.build(), std::make_shared<SampleContacts>());
  s.state.q << 0, 0, 0.0995, 1, 0, 0, 0;
  s.state.v << 0.1, 0, -0.05, 0, 0, 0;
  return s;
}

TEST(SlidingSphere, RowsAreThoseOfTheReference) {
  Scene s = slidingSphere();
  s.step();
  const PyramidalContact& rows = s.data->constraints.contact;
  ASSERT_EQ(rows.rowCount(), 4);
  EXPECT_SMALL(s.data->contacts.contacts[0].distance + 5e-4, 1e-16);
  EXPECT_SMALL(s.data->weights.translation[1] - 1.0, kDigits15);
  EXPECT_SMALL(s.data->weights.rotation[1] - 250.0, 1e-10);
  const double aRef[] = {6.54432132964, 6.54432132964, 17.070637, -3.981994};
  const double force[] = {3.78193680748, 3.78193680748, 5.22402517847, 2.33984843649};
  for (int i = 0; i < 4; ++i) {
    EXPECT_SMALL(1.0 / rows.D[i] - 0.324324324324, 1e-12);
    EXPECT_SMALL(rows.reference[i] - aRef[i], i < 2 ? 1e-11 : 5e-7);
    EXPECT_SMALL(rows.f[i] - force[i], kDigits12);
  }
  VectorX a(6);
  a << -2.88417674198536, 0, 5.3177472299169, 0, 71.9241575032598, 0;
  EXPECT_APPROX(s.data->forward.a, a, kDigits15);
}

TEST(SlidingSphere, IsWhereTheReferenceIsAfter100Steps) {
  Scene s = slidingSphere();
  s.steps(100);
  EXPECT_SMALL(s.state.q[0] - 0.0144893153922848, kDigits15);
  EXPECT_SMALL(s.state.q[2] - 0.0996328458370808, kDigits15);
  EXPECT_SMALL(s.state.q[3] - 0.997643531491107, kDigits15);
  EXPECT_SMALL(s.state.q[5] - 0.0686103787626428, kDigits15);
  EXPECT_SMALL(s.state.v[0] - 0.0713256961961726, kDigits15);
  EXPECT_SMALL(s.state.v[4] - 0.714568598004648, kDigits15);
}

// A pendulum beyond its upper limit, with dry friction.
Scene limitedPendulum() {
  Model model = pendulum(0.5, 1.0, 0.05, 0.01, 0.05).build();
  model.options.tolerance = 1e-15;
  model.options.useMujocoModel();
  model.dofs[0].dryFriction = 0.1;
  JointRange range;
  range.body = 1;
  range.lower = -M_PI / 3;
  range.upper = M_PI / 3;
  model.ranges.push_back(range);
  Scene s(std::move(model));
  s.state.q[0] = 1.0475;
  s.state.v[0] = 0.3;
  return s;
}

TEST(LimitedPendulum, RowsAreThoseOfTheReference) {
  Scene s = limitedPendulum();
  s.stages();
  s.forward();
  EXPECT_SMALL(s.data->weights.dof[0] - 3.83141762452, kDigits12);
  EXPECT_SMALL(s.data->forces.net[0] + 4.26359616695487, kDigits15);
  const DryFriction& friction = s.data->constraints.dryFriction;
  ASSERT_EQ(friction.rowCount(), 1);
  EXPECT_SMALL(1.0 / friction.D[0] - 0.425713069391, 1e-12);
  EXPECT_SMALL(friction.reference[0] + 31.5789473684, 1e-10);
  EXPECT_EQ(friction.f[0], -0.1);
  const JointLimit& row = s.data->constraints.jointLimit;
  ASSERT_EQ(row.rowCount(), 1);
  EXPECT_EQ(row.sign(0), -1.0);
  // The distance is a difference of 1e-16 in 3e-4; the reference's acceleration grows with it.
  EXPECT_SMALL(1.0 / row.D[0] - 0.382879293281, 1e-11);
  EXPECT_SMALL(row.reference[0] - 32.3406387311, 1e-9);
  EXPECT_SMALL(row.f[0] - 3.70687679948, 1e-10);
  EXPECT_SMALL(s.data->forward.a[0] + 30.9213523618168, 1e-10);
}

TEST(LimitedPendulum, IsWhereTheReferenceIsAfter100Steps) {
  Scene s = limitedPendulum();
  s.steps(100);
  EXPECT_SMALL(s.state.q[0] - 0.783774330379594, kDigits15);
  EXPECT_SMALL(s.state.v[0] + 2.72515817861761, kDigits15);
}

// A free box of half extents (0.1, 0.2, 0.3) and 2 kg.
TEST(FreeBox, HasTheInverseWeightsOfTheReference) {
  const Model model = freeBody(boxLink("box", 2.0, {0.1, 0.2, 0.3})).build();
  const InverseWeights w(model);
  EXPECT_SMALL(w.translation[1] - 0.5, kDigits15);
  EXPECT_SMALL(w.rotation[1] - 18.8461538462, 1e-10);
}

}  // namespace
}  // namespace softgauss::test
