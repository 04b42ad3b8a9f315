// SPDX-License-Identifier: Apache-2.0
#include "tests/gdd/gdd_scene.hpp"

#include <Eigen/Cholesky>

#include "tests/support/reference_solver.hpp"

namespace softgauss::test {

GddScene::GddScene(Scene s)
    : scene(std::move(s)),
      cost(scene.model.nv),
      limits(scene.model),
      solver(std::make_unique<gdd::AugmentedLagrangian>(scene.model)) {
  const int n = scene.model.nv;
  const ConvexProblem physics = denseProblem(data());
  dense.M = data().inertia.M.dense();
  dense.Mhat = physics.M;
  dense.Minv = dense.Mhat.llt().solve(MatrixX::Identity(n, n));
  dense.c = data().forces.c;
  dense.J = physics.J;
  dense.aRef = physics.aRef;
  dense.D = physics.D;
  dense.forceLower = physics.lower;
  dense.forceUpper = physics.upper;
  dense.A.resize(0, n);
  dense.offset = VectorX::Zero(n);
  dense.lambda = VectorX::Zero(n);
  dense.rho.resize(n);
  for (int i = 0; i < n; ++i) dense.rho[i] = solver->options.penalty * data().weights.dof[i];
  matchBox();
}

void GddScene::matchBox() {
  dense.lower = limits.lower;
  dense.upper = limits.upper;
  dense.C = limits.transmission ? limits.transmission->C() : MatrixX();
}

void GddScene::addPoint(int body, const Vector3& p_WP, double weight, const Vector3& target) {
  cost.addPoint(model(), data().kinematics, data().inertia.sparsity, body, p_WP, weight, target);
  Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, dofs());
  pointJacobian(model(), data().kinematics, body, p_WP, J);
  const Eigen::Index before = dense.A.rows();
  dense.A.conservativeResize(before + 3, Eigen::NoChange);
  dense.A.bottomRows(3) = J;
  dense.y.conservativeResize(before + 3);
  dense.y.tail(3) = target;
  dense.w.conservativeResize(before + 3);
  dense.w.tail(3).setConstant(weight);
}

void GddScene::addMetric(double weight, const VectorX& target) {
  cost.addMetric(weight, data().inertia.M, target);
  dense.metric += weight;
  dense.offset -= weight * target;
}

void GddScene::addForce(double weight, const Vector3& target,
                        const std::vector<std::pair<int, gdd::ContactForceCost::Map>>& contacts) {
  cost.forces().add(weight, target);
  const Eigen::Index before = dense.B.rows();
  const MatrixX old = dense.B;
  dense.B.setZero(before + 3, dense.rows());
  if (before > 0) dense.B.topRows(before) = old;
  dense.yf.conservativeResize(before + 3);
  dense.yf.tail(3) = target;
  dense.wf.conservativeResize(before + 3);
  dense.wf.tail(3).setConstant(weight);
  const PyramidalContact& made = data().constraints.contact;
  const int first = dense.rows() - made.rowCount();  // the last of the kinds in use
  for (const auto& [i, C] : contacts) {
    cost.forces().addContact(Cone::pyramidal, i, C);
    const ContactRows& rows = made.contactsWithRows()[i];
    // Edge ± of direction k: f along the normal, ± μ_k f along k.
    for (int edge = 0; edge < std::max(1, 2 * rows.frictionDim); ++edge) {
      auto column = dense.B.col(first + rows.row + edge);
      column.tail(3) += C.col(0);
      if (rows.frictionDim == 0) continue;
      const int k = edge / 2;
      column.tail(3) += (edge % 2 == 0 ? 1.0 : -1.0) * rows.friction[k] * C.col(k + 1);
    }
  }
}

void GddScene::addRandomForces(Random& random) {
  constexpr double kWeights[] = {0.01, 0.1, 1.0};
  const int made = static_cast<int>(data().constraints.contact.contactsWithRows().size());
  if (made == 0) return;
  for (int goal = 0; goal < 2; ++goal) {
    std::vector<std::pair<int, gdd::ContactForceCost::Map>> contacts;
    for (int i = 0; i < made; ++i) {
      if (!contacts.empty() && random.chance(0.5)) continue;
      gdd::ContactForceCost::Map C;
      for (int column = 0; column < 6; ++column) C.col(column) = random.vector3(1.0);
      contacts.emplace_back(i, C);
    }
    addForce(kWeights[random.index(3)], random.vector3(20.0), contacts);
  }
}

void GddScene::removeForces() {
  cost.forces().clear();
  dense.B.resize(0, dense.rows());
}

void GddScene::addRandomGoals(Random& random) {
  constexpr double kWeights[] = {1.0, 30.0, 1000.0};
  for (int i = 0; i < 2; ++i) {
    const int body = 1 + random.index(model().bodyCount() - 1);
    const Vector3 p = data().kinematics.X_WB[body].p + random.vector3(0.2);
    addPoint(body, p, kWeights[random.index(3)], random.vector3(20.0));
  }
  if (random.chance(0.5)) addMetric(0.1, -10.0 * scene.state.v);
}

void GddScene::addRandomBox(Random& random, double share, double largest) {
  for (int i = 0; i < dofs(); ++i) {
    if (!model().dofs[i].actuated || !random.chance(share)) continue;
    limits.upper[i] = random.uniform(0.1, 1.0) * largest;
    limits.lower[i] = -random.uniform(0.1, 1.0) * largest;
  }
  matchBox();
}

void GddScene::addRandomActuators(Random& random, bool tendons, double largest) {
  std::vector<int> driven;
  for (int i = 0; i < dofs(); ++i)
    if (limits.lower[i] < limits.upper[i]) driven.push_back(i);
  std::vector<gdd::Actuator> actuators;
  const auto coefficient = [&] {
    return (random.chance(0.5) ? 1.0 : -1.0) * random.uniform(0.3, 3.0);
  };
  const auto add = [&](std::vector<gdd::Actuator::Pull> pulls) {
    gdd::Actuator& actuator = actuators.emplace_back();
    actuator.name = "motor" + std::to_string(actuators.size());
    actuator.pulls = std::move(pulls);
    if (random.chance(0.2)) return;
    actuator.lower = -random.uniform(0.1, 1.0) * largest;
    actuator.upper = random.uniform(0.1, 1.0) * largest;
  };
  for (std::size_t k = 0; k < driven.size();) {
    if (k + 1 == driven.size() || random.chance(0.3)) {
      if (random.chance(0.7)) add({{driven[k], coefficient()}});  // else its own
      k += 1;
      continue;
    }
    const int i = driven[k], j = driven[k + 1];
    k += 2;
    add({{i, coefficient()}, {j, coefficient()}});
    if (tendons && random.chance(0.5)) continue;
    // Of the other sense, so that the two are far from parallel.
    const auto& first = actuators.back().pulls;
    add({{i, first[0].coefficient * random.uniform(0.5, 2.0)},
         {j, -first[1].coefficient * random.uniform(0.5, 2.0)}});
  }
  limits = gdd::ControlLimits(model(), std::move(actuators));
  matchBox();
}

void GddScene::randomMultipliers(Random& random, double scale) {
  dense.lambda = random.vector(dofs(), scale);
}

const VectorX& GddScene::solve() {
  report = solver->solve(model(), cost, limits, data(), scene.state.warmstart);
  WarmStart end;
  solver->keepWarmStart(end);
  dense.lambda = end.multipliers;
  for (int i = 0; i < dofs(); ++i) dense.rho[i] = solver->options.penalty * data().weights.dof[i];
  matchBox();
  return solver->acceleration();
}

int GddScene::rowIndex(RowId id) const {
  int first = 0;
  scene.data->constraints.visit([&](const auto& c, int kind) {
    if (kind < id.kind) first += c.rowCount();
  });
  return first + id.row;
}

GddScene randomGddScene(std::uint64_t seed, int contacts, double boxShare,
                        const RandomTreeOptions& options) {
  Random random(seed * 7919 + 17);
  // Between random trees that nothing rests on. With the load of whole forests on each contact the
  // solvers would be tested on other numbers, worse conditioned by a factor of a hundred.
  Scene scene = randomScene(seed, contacts, options);
  scene.model.options.constraintModel = ConstraintModel::mujoco;
  scene.stages();
  GddScene s(std::move(scene));
  s.addRandomGoals(random);
  s.addRandomBox(random, boxShare);
  return s;
}

GddScene lawGddScene(std::uint64_t seed, int contacts, double boxShare) {
  RandomTreeOptions options;
  options.dryFriction = options.equalities = options.springs = options.contactMoments =
      seed % 2 == 1;
  GddScene s = randomGddScene(seed, contacts, boxShare, options);
  Random random(seed + 8000);
  if (seed % 3 == 2) s.addRandomForces(random);
  return s;
}

}  // namespace softgauss::test
