// SPDX-License-Identifier: Apache-2.0
/// Goals of contact forces: their cost, the two solvers on it, and what robots do.

#include "softgauss/io/goals.hpp"
#include "softgauss/io/scene.hpp"
#include "tests/gdd/gdd_scene.hpp"
#include "tests/gdd/robot_scene.hpp"
#include "tests/gdd/solvers.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// What the world exerts on geometries of a link (all moving ones: ""), by the rows' forces: the
/// plain sum over contacts.
struct GroundWrench {
  Vector3 force = Vector3::Zero();
  Vector3 moment = Vector3::Zero();  ///< about the origin of the world

  template <class Contacts>
  void add(const Model& model, const Data& data, const Contacts& contacts,
           const std::string& link) {
    for (int i = 0; i < static_cast<int>(contacts.contactsWithRows().size()); ++i) {
      const Contact& c = data.contacts.contacts[contacts.contactsWithRows()[i].contact];
      const Geometry &A = model.geometries[c.geometryA], &B = model.geometries[c.geometryB];
      const bool onB = A.body == 0, onA = B.body == 0;
      if (onA == onB) continue;
      if (!link.empty() && (onB ? B : A).link != link) continue;
      const double sign = onB ? 1.0 : -1.0;
      force += sign * contacts.force(i);
      moment += sign * (c.p_WC.cross(contacts.force(i)) + contacts.moment(i));
    }
  }
  GroundWrench(const Model& model, const Data& data, const std::string& link = "") {
    add(model, data, data.constraints.contact, link);
    add(model, data, data.constraints.ellipticContact, link);
  }
  /// Where the ground z = 0 pushes.
  Vector3 centre() const { return {-moment.y() / force.z(), moment.x() / force.z(), 0.0}; }
};

/// Which piece every row is in.
std::vector<double> curvatures(const Data& data) {
  std::vector<double> h = data.constraints.contact.h;
  h.insert(h.end(), data.constraints.jointLimit.h.begin(), data.constraints.jointLimit.h.end());
  return h;
}

/// A humanoid on its feet, moving, with its rows at a random acceleration.
struct OnItsFeet {
  RobotScene r;
  VectorX a;

  OnItsFeet(std::uint64_t seed, Cone cone) : r("humanoid") {
    Random random(seed + 77);
    r.model.options.cone = cone;
    r.renew();
    r.state.q[2] -= 0.001;
    r.state.v = random.vector(r.model.nv, 0.1);
    EXPECT_NE(computeStages(r.model, r.input, r.state, r.data, &r.contacts),
              SolveStatus::notFinite);
    a = random.vector(r.model.nv, 5.0);
  }
  void moveTo(const VectorX& at) {
    VectorX g(r.model.nv);
    inverseDynamics(r.model, at, r.data, g);
  }
};

// ∇ℓ by differences of what the contacts give; in a cell of pyramids these are exact.
TEST(ForceGoals, GradientAndCurvatureAreDifferencesOfTheContactForces) {
  for (const Cone cone : {Cone::pyramidal, Cone::elliptic}) {
    int compared = 0, felt = 0;
    double worst = 0.0, worstCurvature = 0.0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      OnItsFeet at(seed, cone);
      RobotScene& r = at.r;
      Random random(seed);
      gdd::ContactForce foot(r.model, "left_foot", random.vector3(100.0));
      foot.axes[static_cast<std::size_t>(random.index(3))] = false;
      foot.weight = 3.0;
      const Vector3 place(0.02, 0.01, 0.0);
      gdd::CenterOfPressure pressure(r.model, gdd::drivenRobot(r.model), place);
      pressure.weight = 200.0;
      gdd::GoalCost cost(r.model.nv);
      foot.addCost({r.model, r.state, r.data}, cost);
      pressure.addCost({r.model, r.state, r.data}, cost);

      const auto value = [&] {
        const GroundWrench left(r.model, r.data, "left_foot"), all(r.model, r.data);
        Vector3 error = left.force - foot.force;
        for (std::size_t i = 0; i < 3; ++i)
          if (!foot.axes[i]) error[static_cast<Eigen::Index>(i)] = 0.0;
        const Vector3 moment = all.moment - place.cross(all.force);
        return 1.5 * error.squaredNorm() + 100.0 * moment.head<2>().squaredNorm();
      };
      gdd::ContactForceTerms terms;
      terms.setCost(cost.forces());
      const auto gradient = [&] {
        VectorX sum = VectorX::Zero(r.model.nv);
        terms.evaluate(r.data.constraints);
        terms.addGradient(r.data.constraints, sum);
        return sum;
      };
      at.moveTo(at.a);
      const VectorX here = gradient();
      const double found = value();
      EXPECT_NEAR(terms.value(), found, 1e-12 * found);
      terms.setJacobian(r.data.constraints, r.model.nv);
      const TreeSparsity dense = TreeSparsity::dense(r.model.nv);
      TreeMatrix H;
      H.resize(dense);
      H.setZero();
      terms.addCurvature(H);
      const std::vector<double> cell = curvatures(r.data);

      const double step = 1e-4;
      const VectorX d = random.vector(r.model.nv, 1.0);
      at.moveTo(at.a + step * d);
      const double plus = value();
      const VectorX ahead = gradient();
      bool same = curvatures(r.data) == cell;
      at.moveTo(at.a - step * d);
      const double minus = value();
      same &= curvatures(r.data) == cell;
      if (!same) continue;
      ++compared;
      felt += here.norm() > 0.0;
      const double scale = here.norm() * d.norm() + 1e-300;
      worst = std::max(worst, std::abs((plus - minus) / (2.0 * step) - here.dot(d)) / scale);
      if (cone == Cone::pyramidal)
        worstCurvature = std::max(worstCurvature, ((ahead - here) / step - H.dense() * d).norm() /
                                                      (H.dense().norm() * d.norm() + 1e-300));
    }
    // Rounding of ℓ over the step; elliptic cones bend, by step² of their third derivative.
    EXPECT_SMALL(worst, cone == Cone::pyramidal ? 1e-8 : 1e-5);
    EXPECT_SMALL(worstCurvature, 1e-8);
    EXPECT_GT(compared, 20);
    EXPECT_GT(felt, 10);
  }
}

// One contact row, one joint: f = D (a_ref − a), so that the least of ½ g²/m + ½ w (f − f*)² has a
// closed form, for either solver.
template <class Solver>
class ForceGoalsOfSolver : public testing::Test {};
TYPED_TEST_SUITE(ForceGoalsOfSolver, GddSolvers);

TYPED_TEST(ForceGoalsOfSolver, OneRowHasAClosedForm) {
  for (const double wished : {50.0, 5.0, -10.0}) {
    ModelBuilder builder("press");
    builder.base = BaseKind::fixed;
    builder.link(emptyLink("world")).link(boxLink("head", 3.0, {0.1, 0.1, 0.1}));
    builder.joint(jointSpec("slide", JointType::prismatic, "world", "head", {}, Vector3::UnitZ()));
    builder.geometry(groundSpec(0.0)).geometry(geometrySpec("head", Shape::sphere(0.1), 0.0));
    Scene scene(builder.build(), std::make_shared<SampleContacts>());
    scene.state.q[0] = 0.099;
    ASSERT_EQ(scene.stages(), SolveStatus::converged);
    GddScene s(std::move(scene));
    ASSERT_EQ(s.dense.rows(), 1);
    const double w = 2.0, m = s.dense.M(0, 0), D = s.dense.D[0], c = s.dense.c[0];
    gdd::ContactForce goal(s.model(), "head", Vector3(0.0, 0.0, wished));
    goal.weight = w;
    goal.addCost({s.model(), s.scene.state, s.data()}, s.cost);
    TypeParam solver(s.model());
    const gdd::GddReport report = solver.solve(s.model(), s.cost, s.limits, s.data(), {});
    // In contact: f = f*(1 + …): minimise ½ (m a + c − f)²/m + ½ w (f − f*)², a = a_ref − f/D.
    const double slope = -(m / D + 1.0);  // dg/df
    const double free = m * s.dense.aRef[0] + c;
    const double f = (w * wished - slope * free / m) / (w + slope * slope / m);
    ASSERT_GT(std::abs(f), 0.1);
    s.data().constraints.setResidual(solver.acceleration());
    bool changed = false;
    s.data().constraints.evaluate(changed);
    if (f > 0.0) {
      EXPECT_EQ(report.status, gdd::GddStatus::converged);
      EXPECT_NEAR(s.data().constraints.contact.f[0], f, 1e-10 * f);
    } else {
      EXPECT_EQ(s.data().constraints.contact.f[0], 0.0);
    }
  }
}

// The same states by both. Each ends at a local minimum, not always the same one; where the second
// starts from what the first found, it does not end above it.
TEST(ForceGoals, BothSolversFindTheSameOrAnotherMinimum) {
  int problems = 0, same = 0, firstLower = 0, secondLower = 0;
  for (std::uint64_t seed = 2; seed < 300; seed += 3) {
    GddScene s = lawGddScene(seed, 5);
    if (s.cost.forces().empty()) continue;
    s.solve();
    const double one = s.report.objective;
    const bool finished = s.report.status == gdd::GddStatus::converged ||
                          s.report.status == gdd::GddStatus::nonsmoothMinimum;
    gdd::ActiveSet second(s.model());
    const auto solve = [&](const WarmStart& warm) {
      const gdd::GddReport report = second.solve(s.model(), s.cost, s.limits, s.data(), warm);
      EXPECT_NE(report.status, gdd::GddStatus::notFinite);
      EXPECT_NEAR(report.objective, s.dense.objective(second.acceleration()),
                  1e-9 * (1.0 + std::abs(report.objective)))
          << seed;
      return report.objective;
    };
    const double two = solve(s.scene.state.warmstart);
    const double scale = std::abs(one) + std::abs(two);
    ++problems;
    same += std::abs(one - two) <= 1e-6 * scale;
    firstLower += one < two - 1e-6 * scale;
    secondLower += two < one - 1e-6 * scale;
    if (!finished) continue;
    WarmStart warm;
    s.solver->keepWarmStart(warm);
    warm.control = s.limits.clamp(s.solver->force());
    EXPECT_LE(solve(warm), one + 1e-6 * scale) << seed;
  }
  // Of 100 problems 76 end at one value, 14 lower with the first, 10 with the second. Without the
  // goals of forces the same scenes give 79, 9 and 12.
  EXPECT_GT(problems, 60);
  EXPECT_GE(same, 0.7 * problems) << firstLower << " " << secondLower;
}

// ---- What robots do -----------------------------------------------------------------------------

std::string goalsFile(const std::string& name) {
  return std::string(SOFTGAUSS_SOURCE_DIR) + "/data/goals/" + name + ".yaml";
}

void run(RobotScene& r, double seconds) {
  const double end = r.state.time + seconds - 0.5 * r.model.options.timestep;
  while (r.state.time < end) {
    const SolveStatus status = r.step();
    ASSERT_NE(status, SolveStatus::notFinite) << "at " << r.state.time << " s";
  }
}

/// Largest difference between the forces that the controller assumed in the last step and those
/// that its control makes by (1.1) [N].
double mismatch(RobotScene& r) {
  VectorX g(r.model.nv);
  inverseDynamics(r.model, r.data.forward.a, r.data, g);
  const GroundWrench acting(r.model, r.data);
  inverseDynamics(r.model, r.controller.acceleration(), r.data, g);
  const GroundWrench assumed(r.model, r.data);
  return (acting.force - assumed.force).norm();
}

/// How far the load on the right foot is from 120 N in shift_weight.yaml: at most while the body
/// leans over, and in the last of four seconds [N].
struct LoadError {
  double leaning = 0.0, last = 0.0;
};

LoadError loadError(bool withForceGoal) {
  RobotScene r("humanoid");
  io::readGoalFile(goalsFile("shift_weight"), r.model, r.state).giveTo(r.controller);
  if (!withForceGoal) r.controller.goals.pop_back();
  run(r, 1.0);
  EXPECT_GT(GroundWrench(r.model, r.data, "right_foot").force.z(), 0.45 * kWeight);
  const Vector3 left = r.position("left_foot"), right = r.position("right_foot");
  LoadError error;
  double differing = 0.0;
  for (int i = 0; i < 1500; ++i) {
    EXPECT_NE(r.step(), SolveStatus::notFinite);
    const GroundWrench foot(r.model, r.data, "right_foot");
    double& worst = i < 500 ? error.leaning : error.last;
    if (i < 500 || i >= 1000) worst = std::max(worst, std::abs(foot.force.z() - 120.0));
    if (i % 50 == 0 && i >= 1000) differing = std::max(differing, mismatch(r));
  }
  EXPECT_SMALL(differing / kWeight, 1e-8);
  EXPECT_NEAR(GroundWrench(r.model, r.data).force.z(), kWeight, 0.01 * kWeight);
  EXPECT_GT(r.data.kinematics.X_WB[1].p.z(), 0.9) << "the pelvis is to stay up";
  EXPECT_SMALL((r.position("left_foot") - left).norm(), 0.001);
  EXPECT_SMALL((r.position("right_foot") - right).norm(), 0.001);
  return error;
}

// data/goals/shift_weight.yaml: 30 % of the weight, steadily, to 1 % of it. The foot that pushes
// the body over would carry 80 % of the weight without the goal for its load.
TEST(ForceBehaviour, TheHumanoidShiftsItsWeight) {
  const LoadError with = loadError(true), without = loadError(false);
  EXPECT_SMALL(with.last, 0.01 * kWeight);
  EXPECT_SMALL(with.leaning, 0.3 * kWeight);
  EXPECT_GT(without.leaning, 0.45 * kWeight);
}

// data/goals/move_pressure.yaml: from 1 s to 1.2 s. The body is thrown back, and comes to rest
// again.
TEST(ForceBehaviour, TheCentreOfPressureGoesWhereItIsAsked) {
  RobotScene r("humanoid");
  io::readGoalFile(goalsFile("move_pressure"), r.model, r.state).giveTo(r.controller);
  run(r, 1.0);
  const Vector3 target(0.04, 0.0, 0.0);
  const Vector3 left = r.position("left_foot"), right = r.position("right_foot");
  const Vector3 pelvis = r.position("pelvis");
  EXPECT_GT((GroundWrench(r.model, r.data).centre() - target).norm(), 0.03);
  double off = 0.0, differing = 0.0, measured = 0.0;
  const auto& goal = dynamic_cast<const gdd::CenterOfPressure&>(*r.controller.goals.back());
  while (r.state.time < 1.1999) {
    ASSERT_NE(r.step(), SolveStatus::notFinite);
    const GroundWrench ground(r.model, r.data);
    off = std::max(off, (ground.centre() - target).norm());
    measured = std::max(measured, (*goal.measured(r.data) - ground.centre()).norm());
    differing = std::max(differing, mismatch(r));
  }
  EXPECT_SMALL(off, 0.001);
  EXPECT_SMALL(measured, 1e-9);
  EXPECT_SMALL(differing / kWeight, 1e-8);
  run(r, 2.8);
  // The held feet are where they were; so is the pelvis.
  EXPECT_SMALL((r.position("left_foot") - left).norm(), 0.001);
  EXPECT_SMALL((r.position("right_foot") - right).norm(), 0.001);
  EXPECT_SMALL((r.position("pelvis") - pelvis).norm(), 0.003);
}

// Long before the body has moved: within one step.
TEST(ForceBehaviour, PressureMovesAtOnce) {
  for (const Cone cone : {Cone::pyramidal, Cone::elliptic}) {
    RobotScene r("humanoid");
    r.model.options.cone = cone;
    r.addPosture();
    run(r, 0.5);
    const Vector3 before = GroundWrench(r.model, r.data).centre();
    const Vector3 target = before + Vector3(0.02, -0.03, 0.0);
    auto goal = std::make_unique<gdd::CenterOfPressure>(r.model, gdd::drivenRobot(r.model), target);
    goal->weight = 1e6;
    r.controller.goals.push_back(std::move(goal));
    ASSERT_NE(r.step(), SolveStatus::notFinite);
    const GroundWrench ground(r.model, r.data);
    EXPECT_SMALL((ground.centre() - target).norm(), 0.001);
    EXPECT_GT(ground.force.z(), 0.5 * kWeight);
    EXPECT_SMALL(mismatch(r) / kWeight, 1e-8);
  }
}

// data/scenes/arm_presses_table.yaml.
TEST(ForceBehaviour, TheArmPressesATable) {
  const std::string file =
      std::string(SOFTGAUSS_SOURCE_DIR) + "/data/scenes/arm_presses_table.yaml";
  io::SceneFile scene = io::readScene(file);
  const Model model = scene.builder.build();
  State state = scene.initialState(model);
  Data data(model);
  collision::SceneContacts contacts(model);
  gdd::GoalDirectedController controller(model);
  io::readGoalFile(file, model, state).giveTo(controller);
  const gdd::ContactForce hand(model, "hand", Vector3::Zero());
  for (int i = 0; i < 2000; ++i)
    ASSERT_NE(controller.step(model, Input{}, state, data, &contacts), SolveStatus::notFinite);
  double worst = 0.0, differing = 0.0;
  for (int i = 0; i < 500; ++i) {
    ASSERT_NE(controller.step(model, Input{}, state, data, &contacts), SolveStatus::notFinite);
    worst = std::max(worst, std::abs(hand.measured(data).z() - 20.0));
    VectorX g(model.nv);
    inverseDynamics(model, data.forward.a, data, g);  // of (1.1), not of mid-step
    const double acting = hand.measured(data).z();
    inverseDynamics(model, controller.acceleration(), data, g);
    differing = std::max(differing, std::abs(hand.measured(data).z() - acting));
  }
  EXPECT_SMALL(worst, 0.5);
  EXPECT_SMALL(differing, 1e-8 * 20.0);
}

// A force goal of a hand in the air asks for nothing: the same bits as without.
TEST(ForceGoals, WithoutContactChangeNothing) {
  RobotScene with("arm"), without("arm");
  for (RobotScene* r : {&with, &without}) {
    r->addReach("hand", Vector3(0.5, 0.3, 0.5));
    r->addDamping();
  }
  auto force = std::make_unique<gdd::ContactForce>(with.model, "hand", Vector3(0.0, 0.0, 1e4));
  force->weight = 1e6;  // its cost is a constant, however large
  with.controller.goals.push_back(std::move(force));
  for (int i = 0; i < 100; ++i) {
    ASSERT_NE(with.step(), SolveStatus::notFinite);
    ASSERT_NE(without.step(), SolveStatus::notFinite);
  }
  EXPECT_EQ((with.state.q - without.state.q).norm(), 0.0);
}

TEST(ForceGoals, CountTheContactsTheyName) {
  RobotScene r("humanoid");
  gdd::ContactForce all(r.model, "left_foot", Vector3::Zero()), ground = all, other = all;
  ground.countOnly(r.model, "world");
  other.countOnly(r.model, "right_foot");
  r.addPosture();
  run(r, 0.3);
  const Vector3 expected = GroundWrench(r.model, r.data, "left_foot").force;
  EXPECT_GT(expected.z(), 0.2 * kWeight);
  EXPECT_EQ(ground.measured(r.data), all.measured(r.data));
  EXPECT_APPROX(ground.measured(r.data), expected, 1e-12);
  EXPECT_EQ(other.measured(r.data), Vector3::Zero().eval());
  EXPECT_THROW(gdd::ContactForce(r.model, "left_fot", Vector3::Zero()), ModelError);
  EXPECT_THROW(gdd::ContactForce(r.model, "torso_stage", Vector3::Zero()), ModelError);
}

}  // namespace
}  // namespace softgauss::test
