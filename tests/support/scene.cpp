// SPDX-License-Identifier: Apache-2.0
#include "tests/support/scene.hpp"

#include <tuple>
#include <utility>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/core/rotation.hpp"
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
void addDryFriction(Model& model, Random random) {
  for (Dof& dof : model.dofs) {
    if (!random.chance(0.5)) continue;
    dof.dryFriction = random.uniform(0.1, 5.0);
    dof.frictionImpedance.dMin = random.uniform(0.5, 0.95);
  }
}

/// Springs on half of the scalar joints.
void addSprings(Model& model, Random random) {
  for (Dof& dof : model.dofs) {
    if (model.bodies[dof.body].dofs != 1 || !random.chance(0.5)) continue;
    dof.stiffness = random.uniform(1.0, 50.0);
    dof.springReference = random.uniform(-0.5, 0.5);
  }
}

void addContactMoments(Model& model, Random random) {
  for (Geometry& g : model.geometries) {
    constexpr int kCondims[] = {1, 3, 4, 6};
    g.material.condim = kCondims[random.index(4)];
    g.material.torsionalFriction = random.uniform(0.01, 0.2);
    g.material.rollingFriction = random.uniform(0.01, 0.1);
  }
}

void addEqualities(Scene& scene, Random random) {
  Model& model = scene.model;
  computeKinematics(model, scene.state, scene.data->kinematics);
  const std::vector<Transform>& X_WB = scene.data->kinematics.X_WB;
  const auto almost = [&](const Transform& X) {
    return Transform{X.R * quaternionExp(random.vector3(1e-3)).toRotationMatrix(),
                     X.p + random.vector3(1e-3)};
  };
  const auto anyBody = [&] { return random.index(model.bodyCount()); };
  Connection connection;
  connection.bodyA = anyBody();
  connection.bodyB =
      (connection.bodyA + 1 + random.index(model.bodyCount() - 1)) % model.bodyCount();
  connection.p_AP = random.vector3(0.2);
  const Transform at{Matrix3::Identity(), X_WB[connection.bodyA] * connection.p_AP};
  connection.p_BP = X_WB[connection.bodyB].inverse() * almost(at).p;
  connection.centers = {model.bodies[idx(connection.bodyA)].com,
                        model.bodies[idx(connection.bodyB)].com};
  model.connections.push_back(connection);
  Weld weld;
  weld.bodyA = anyBody();
  weld.bodyB = (weld.bodyA + 1 + random.index(model.bodyCount() - 1)) % model.bodyCount();
  weld.X_AF = {random.rotation(), random.vector3(0.2)};
  weld.X_BF = X_WB[weld.bodyB].inverse() * almost(X_WB[weld.bodyA] * weld.X_AF);
  weld.torqueScale = random.uniform(0.2, 2.0);
  weld.centers = {model.bodies[idx(weld.bodyA)].com, model.bodies[idx(weld.bodyB)].com};
  model.welds.push_back(weld);
  std::vector<int> scalar;
  for (int b = 1; b < model.bodyCount(); ++b)
    if (model.bodies[b].dofs == 1) scalar.push_back(b);
  for (const int leads : {1, 0}) {
    JointCoupling coupling;
    const int count = static_cast<int>(scalar.size()), i = random.index(count);
    coupling.follower = scalar[i];
    coupling.leader = leads ? scalar[(i + 1 + random.index(count - 1)) % count] : 0;
    for (double& c : coupling.polynomial) c = random.uniform(-1.0, 1.0);
    const double leader = leads ? scene.state.q[model.bodies[coupling.leader].q] : 0.0;
    const double off = scene.state.q[model.bodies[coupling.follower].q] -
                       (leads ? coupling.value(leader) : coupling.polynomial[0]);
    coupling.polynomial[0] += off + random.uniform(-1e-3, 1e-3);
    model.couplings.push_back(coupling);
  }
}

}  // namespace

Scene randomScene(std::uint64_t seed, int contacts, const RandomTreeOptions& options) {
  Random random(seed ^ 0x9e3779b97f4a7c15ull);
  Scene scene(randomForest(seed, options).build());
  const Model& model = scene.model;
  // Slow enough that joints with dry friction stick as well as slide.
  scene.state = randomState(model, random, options.dryFriction ? 0.1 : 2.0);
  if (options.dryFriction) addDryFriction(scene.model, Random(seed + 5000));
  if (options.springs) addSprings(scene.model, Random(seed + 7000));
  if (options.contactMoments) addContactMoments(scene.model, Random(seed + 8000));
  if (options.equalities) addEqualities(scene, Random(seed + 6000));
  scene.data = std::make_unique<Data>(scene.model);  // of the model as it is now
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
  options.dryFriction = options.equalities = options.springs = options.contactMoments =
      seed % 2 == 1;
  return randomScene(seed, contacts, options);
}

namespace {

std::pair<double, double> forceBounds(const HalfQuadratic&) { return {0.0, kInfinity}; }
std::pair<double, double> forceBounds(const Quadratic&) { return {-kInfinity, kInfinity}; }
std::pair<double, double> forceBounds(const Huber& s) { return {-s.limit, s.limit}; }

}  // namespace

ConvexProblem denseProblem(const Data& data) {
  ConvexProblem problem;
  problem.M = data.inertia.M.dense();
  problem.M.diagonal() += data.inertia.added;
  problem.net = data.forces.net;
  problem.J = data.constraints.denseJacobian();
  const int rows = data.constraints.rowCount();
  problem.aRef.resize(rows);
  problem.D.resize(rows);
  problem.lower.resize(rows);
  problem.upper.resize(rows);
  int row = 0;
  data.constraints.visit([&](const auto& c) {
    if constexpr (requires { c.penalty(0); })
      for (int i = 0; i < c.rowCount(); ++i, ++row) {
        problem.aRef[row] = c.reference[i];
        problem.D[row] = c.D[i];
        std::tie(problem.lower[row], problem.upper[row]) = forceBounds(c.penalty(i));
      }
  });
  if (row != rows) throw std::logic_error("cones are no rows of scalar penalties");
  return problem;
}

}  // namespace softgauss::test
