// SPDX-License-Identifier: Apache-2.0
/// A step with rows is the solution of (T.1) at the velocity of mid-step (T.123).

#include "collision/scene_contacts.hpp"
#include "tests/laws/law_measures.hpp"
#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {
namespace {

/// A wheel and a ball out of balance, both free, that lean on the ground and go any way. They are
/// so soft that at these speeds friction answers all of J̇ v, at v as at v_m.
std::unique_ptr<Scene> wheelAndBall(std::uint64_t seed) {
  Random random(seed);
  ModelBuilder builder("wheel and ball");
  builder.options.timestep = 1e-3;
  builder.geometry(groundSpec(1.0));
  const double lean = random.uniform(0.2, 1.2), depth = random.uniform(1e-4, 1e-3);
  const double R = 0.1, half = 0.02;
  const auto add = [&](const std::string& name, const Shape& shape, const Transform& X_WB,
                       const Vector3& com) {
    ModelBuilder one(name);
    one.base = BaseKind::floating;
    one.X_WRoot = X_WB;
    one.link(boxLink(name, random.uniform(0.5, 2.0), {0.05, 0.07, 0.02}, com));
    GeometrySpec surface = geometrySpec(name, shape, 1.0);
    surface.material.impedance.dMin = surface.material.impedance.dMax = 0.3;
    surface.material.impedance.timeConstant = 0.1;
    surface.material.priority = 1;
    one.geometry(surface);
    builder.add(one, "");
  };
  const Eigen::AngleAxisd turn(lean, Vector3::UnitX());
  const double height = R * std::sin(lean) + half * std::cos(lean) - depth;
  add("wheel", Shape::cylinder(R, half), {turn.toRotationMatrix(), {0, 0, height}},
      Vector3::Zero());
  add("ball", Shape::sphere(R), {random.rotation(), {1.0, 0, R - depth}}, random.vector3(0.03));
  auto own = std::make_unique<Scene>(builder.build());
  Scene& s = *own;
  s.contacts = std::make_shared<collision::SceneContacts>(s.model);
  s.input.softFriction = true;  // (T.97) makes D of the speed
  s.state.v = random.vector(s.model.nv, 10.0);
  for (const int v : {0, 6}) s.state.v.segment<3>(v) = random.vector3(0.3);
  return own;
}

/// What the references have of the bodies' turning, by leaving it out: J̇ v of every row.
VectorX turning(Scene& s) {
  std::vector<double> with, without;
  VectorX share(s.data->constraints.rowCount());
  s.data->constraints.copyReferences(with);
  s.data->constraints.leaveOutTurning([](int) { return true; });
  s.data->constraints.copyReferences(without);
  s.data->constraints.setReferences(with);
  int row = 0;
  s.data->constraints.visit([&](const auto& c) {
    for (const double b : c.damping) share[row++] = 1.0 - 0.5 * s.model.options.timestep * b;
  });
  for (int i = 0; i < row; ++i) share[i] = (without[i] - with[i]) / share[i];
  return share;
}

TEST(MidStep, IsTheSolutionAtTheVelocityOfMidStep) {
  double worst = 0.0, least = kInfinity, changed = 0.0;
  int compared = 0;
  for (int seed = 0; seed < 100; ++seed) {
    const auto atStart = wheelAndBall(seed), atMiddle = wheelAndBall(seed);
    Scene &s = *atStart, &middle = *atMiddle;
    const State start = s.state;
    s.stages();
    ASSERT_EQ(s.forward(), SolveStatus::converged);
    const VectorX a = s.data->forward.a, bias = turning(s);
    std::vector<double> references;
    s.data->constraints.copyReferences(references);
    const std::vector<double> forces = s.data->constraints.contact.f;
    ASSERT_GT(forces.size(), 0u);

    // (T.1) at v_m: its own Coriolis forces, J̇ v of v_m, all else of v.
    middle.state.v += 0.5 * s.model.options.timestep * a;
    middle.stages();
    const VectorX change = turning(middle) - bias;
    for (std::size_t i = 0; i < references.size(); ++i)
      references[i] -= change[static_cast<Eigen::Index>(i)];
    middle.data->constraints.setReferences(references);
    ASSERT_EQ(middle.forward(), SolveStatus::converged);

    const std::vector<double>& then = middle.data->constraints.contact.f;
    bool sameCell = then.size() == forces.size();
    for (std::size_t i = 0; sameCell && i < then.size(); ++i)
      sameCell = (then[i] > 0.0) == (forces[i] > 0.0);
    if (!sameCell) continue;  // one step of Newton's is not enough
    ++compared;
    ASSERT_EQ(s.step(), SolveStatus::converged);
    ASSERT_EQ(s.data->stats.followedTrees, 0);
    const VectorX taken = (s.state.v - start.v) / s.model.options.timestep;
    worst = std::max(worst, (taken - middle.data->forward.a).norm() / a.norm());
    changed = std::max(changed, (taken - a).norm() / a.norm());
    least = std::min(least, change.cwiseAbs().maxCoeff());
  }
  // The solves end at 1e-12 of the forces, M is conditioned to 1e3; (v⁺ − v)/h loses 1e-13/h.
  EXPECT_SMALL(worst, 1e-8);
  EXPECT_GT(changed, 1e-3);
  EXPECT_GT(least, 0.0);
  EXPECT_GT(compared, 50);
}

}  // namespace
}  // namespace softgauss::test
