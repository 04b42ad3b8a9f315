// SPDX-License-Identifier: Apache-2.0
#include "tests/support/scene.hpp"

#include <tuple>
#include <utility>

#include "tests/support/reference_solver.hpp"

namespace softgauss::test {

State randomState(const Model& model, Random& random, double speed) {
  State state(model);
  state.v = random.vector(model.nv, speed);
  for (const Body& body : model.bodies) {
    if (body.joint == JointKind::world) continue;
    state.q[body.q] = random.uniform(-1.0, 1.0);
    if (body.joint != JointKind::floating) continue;
    state.q.segment<3>(body.q) = random.vector3(1.0);
    const Quaternion r = random.quaternion();
    state.q.segment<4>(body.q + 3) << r.w(), r.x(), r.y(), r.z();
  }
  for (const JointRange& range : model.ranges) {
    double& q = state.q[model.bodies[range.body].q];
    const double end = random.chance(0.5) ? range.lower : range.upper;
    q = random.chance(0.5) ? random.uniform(range.lower, range.upper)
                           : end + random.uniform(-0.01, 0.01);
  }
  return state;
}

namespace {

/// Dry friction in half of the joints.
void addRandomEffects(Model& model, Random random) {
  for (Dof& dof : model.dofs) {
    if (!random.chance(0.5)) continue;
    dof.dryFriction = random.uniform(0.1, 5.0);
    dof.frictionImpedance.dMin = random.uniform(0.5, 0.95);
  }
}

}  // namespace

Scene randomScene(std::uint64_t seed, int contacts, const RandomTreeOptions& options) {
  Random random(seed ^ 0x9e3779b97f4a7c15ull);
  Scene scene(randomForest(seed, options).build());
  const Model& model = scene.model;
  if (options.effects) addRandomEffects(scene.model, Random(seed + 5000));
  // Slow enough that joints with dry friction stick as well as slide.
  scene.state = randomState(model, random, options.effects ? 0.1 : 2.0);
  scene.input.tau = random.vector(model.nv, 10.0);
  for (int i = 0; i < 2; ++i)
    scene.input.wrenches.push_back(
        {1 + random.index(model.bodyCount() - 1), {random.vector3(2.0), random.vector3(10.0)}});
  if (contacts > 0) {
    computeKinematics(model, scene.state, scene.data->kinematics);
    scene.contacts = std::make_shared<FixedContacts>(
        randomContacts(model, scene.data->kinematics, random, contacts));
  }
  scene.stages();
  return scene;
}

Scene lawScene(std::uint64_t seed, int contacts) {
  RandomTreeOptions options;
  options.effects = seed % 2 == 1;
  return randomScene(seed, contacts, options);
}

namespace {

std::pair<double, double> forceBounds(const HalfQuadratic&) { return {0.0, kInfinity}; }
std::pair<double, double> forceBounds(const Huber& s) { return {-s.limit, s.limit}; }

}  // namespace

ConvexProblem denseProblem(const Data& data) {
  ConvexProblem problem;
  problem.M = data.inertia.M.dense();
  problem.net = data.forces.net;
  problem.J = data.constraints.denseJacobian();
  const int rows = data.constraints.rowCount();
  problem.aRef.resize(rows);
  problem.D.resize(rows);
  problem.lower.resize(rows);
  problem.upper.resize(rows);
  int row = 0;
  data.constraints.visit([&](const auto& c) {
    for (int i = 0; i < c.rowCount(); ++i, ++row) {
      problem.aRef[row] = c.reference[i];
      problem.D[row] = c.D[i];
      std::tie(problem.lower[row], problem.upper[row]) = forceBounds(c.penalty(i));
    }
  });
  return problem;
}

}  // namespace softgauss::test
