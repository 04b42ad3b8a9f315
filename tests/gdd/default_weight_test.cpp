// SPDX-License-Identifier: Apache-2.0
/// What a goal without a weight weighs beside a posture, and what a posture leaves to it.

#include "softgauss/engine/dynamics/jacobian.hpp"
#include "tests/gdd/goal_check.hpp"
#include "tests/gdd/robot_scene.hpp"

namespace softgauss::test {
namespace {

const Vector3 kPlace(0.5, 0.3, 0.5);  // for the arm's hand [m]

void run(RobotScene& r, double seconds) {
  while (r.state.time < seconds && !testing::Test::HasFailure())
    ASSERT_EQ(r.step(), SolveStatus::converged);
}

void weigh(RobotScene& r) { gdd::weighDefaults(r.model, r.controller.goals); }

/// Rows of the translation of a link's origin (3 × nv).
MatrixX rowsOf(const RobotScene& r, const Kinematics& k, const std::string& link) {
  const int frame = r.model.findFrame(link);
  Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, r.model.nv);
  pointJacobian(r.model, k, r.model.frames[frame].body, framePose(r.model, k, frame).p, J);
  return J;
}

// At rest w_p k_p M (q* ⊖ q) + w k_r Jᵀe = 0, so that e = −(w_p k_p / w k_r) Λ J (q* ⊖ q).
TEST(DefaultWeight, OfTwoWeightsThatAreGivenTheBalanceIsWhatTheRuleSays) {
  for (const double weight : {20.0, 1e3, 1e5}) {
    RobotScene arm("arm");
    gdd::Reach& reach = arm.addReach("hand", kPlace);
    gdd::Posture& posture = arm.addPosture();
    reach.weight = weight;
    reach.defaultWeight.giveUp();
    posture.weight = 1000.0;
    weigh(arm);
    EXPECT_EQ(reach.weight, weight);
    EXPECT_TRUE(posture.yieldsTo.empty());
    run(arm, 12.0);
    const Kinematics k = kinematicsAt(arm.model, arm.state);
    const MatrixX J = rowsOf(arm, k, "hand"), M = arm.data.inertia.M.dense();
    const VectorX away = positionDifference(arm.model, arm.state.q, posture.q);
    const Eigen::Matrix3d inverse = J * M.llt().solve(J.transpose());
    const Vector3 left = -(posture.weight * posture.stiffness / (weight * reach.stiffness)) *
                         inverse.llt().solve(Vector3(J * away));
    const Vector3 e = kPlace - arm.position("hand");
    EXPECT_GT(e.norm(), 1e-5);
    // What still moves after 12 s, against the way of 0.5 m.
    EXPECT_LT((e - left).norm(), 0.01 * e.norm() + 1e-6) << weight;
  }
}

TEST(DefaultWeight, AnArmReachesWhateverThePostureWeighs) {
  for (const double weight : {0.01, 1.0, 1e3, 1e5}) {
    RobotScene arm("arm");
    arm.addReach("hand", kPlace);
    gdd::Posture& posture = arm.addPosture();
    posture.weight = weight;
    arm.addDamping();
    weigh(arm);
    run(arm, 6.0);
    // Of 500 mm a share of ε = 10⁻⁴ at most, by what a link is heavier across than along its rows.
    EXPECT_LT((arm.position("hand") - kPlace).norm(), 5e-4) << weight;
    EXPECT_LT(arm.state.v.cwiseAbs().maxCoeff(), 0.05) << weight;
  }
}

TEST(DefaultWeight, AHumanoidReachesAndStands) {
  RobotScene humanoid("humanoid");
  const Vector3 place(0.45, -0.25, 1.10);
  humanoid.addReach("right_hand", place);
  humanoid.addPosture();
  humanoid.addDamping();
  weigh(humanoid);
  const Vector3 torso = humanoid.position("torso");
  run(humanoid, 3.0);
  EXPECT_LT((humanoid.position("right_hand") - place).norm(), 1e-3);
  EXPECT_LT(std::abs(humanoid.position("torso").z() - torso.z()), 0.05);
}

/// Two places of random links, one with its orientation.
std::vector<gdd::LedPlace> randomPlaces(const Model& model, Random& random) {
  std::vector<gdd::LedPlace> places;
  for (const bool turns : {false, true})
    places.push_back({randomMovingFrame(model, random), random.vector3(0.2), turns});
  return places;
}

std::unique_ptr<gdd::Posture> yieldingPosture(const Scene& scene, Random& random) {
  VectorX reference = scene.state.q;
  integratePosition(scene.model, random.vector(scene.model.nv, 1.0), 1.0, reference);
  auto goal = std::make_unique<gdd::Posture>(reference);
  goal->weight = random.uniform(0.1, 1e3);
  goal->yieldsTo = randomPlaces(scene.model, random);
  return goal;
}

TEST(YieldingPosture, KeepsTheLawsOfCosts) {
  expectLawsOfGoals(
      [](const Scene& scene, Random& random) { return yieldingPosture(scene, random); });
}

// (9.24) in dense matrices; and N shortens what it takes, in the metric M.
TEST(YieldingPosture, IsItsFormula) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed + 40);
    const Scene scene = looseScene(seed);
    const auto goal = yieldingPosture(scene, random);
    const Kinematics k = kinematicsAt(scene.model, scene.state);
    const int n = scene.model.nv;
    MatrixX J(9, n);
    Eigen::Matrix<double, 3, Eigen::Dynamic> rows(3, n);
    int used = 0;
    for (const gdd::LedPlace& place : goal->yieldsTo) {
      const int body = scene.model.frames[place.frame].body;
      pointJacobian(scene.model, k, body, framePose(scene.model, k, place.frame) * place.p_FP,
                    rows);
      J.middleRows(used, 3) = rows;
      used += 3;
      if (!place.turns) continue;
      rotationJacobian(scene.model, k, body, rows);
      J.middleRows(used, 3) = rows;
      used += 3;
    }
    ASSERT_EQ(used, 9);
    const MatrixX M = scene.data->inertia.M.dense();
    const MatrixX inverseRows = M.llt().solve(J.transpose());
    MatrixX C = J * inverseRows;
    for (int i = 0; i < 9; ++i) C(i, i) = C(i, i) > 0.0 ? (1.0 + 1e-4) * C(i, i) : 1.0;
    const VectorX d = positionDifference(scene.model, scene.state.q, goal->q);
    const VectorX left = d - inverseRows * C.llt().solve(J * d);
    EXPECT_LE(left.dot(M * left), (1.0 + 1e-9) * d.dot(M * d));
    const VectorX wish = goal->stiffness * left - goal->damping * scene.state.v;
    const auto formula = [&](const VectorX& a) {
      return 0.5 * goal->weight * (a - wish).dot(M * (a - wish));
    };
    const VectorX a = random.vector(n, 10.0), zero = 0.0 * a;
    const GoalCheck check(scene, *goal);
    const double size = formula(a) + formula(zero);
    // C has a condition of 1/ε.
    EXPECT_SMALL((check.value(a) - check.value(zero) - formula(a) + formula(zero)) / size, 1e-9);
  }
}

TEST(DefaultWeight, CountsAsManyTimesAsTheStrongestPostureBesideItWeighs) {
  RobotScene arm("arm");
  gdd::Reach& reach = arm.addReach("hand", kPlace);
  gdd::Reach& other = arm.addReach("forearm", kPlace);
  const double alone = reach.weight, turning = reach.rotationWeight;
  other.weight = 7.0;
  weigh(arm);
  EXPECT_EQ(reach.weight, alone);
  gdd::Posture& posture = arm.addPosture();
  posture.weight = 300.0;
  weigh(arm);
  EXPECT_EQ(reach.weight, 300.0 * alone);
  EXPECT_EQ(reach.rotationWeight, 300.0 * turning);
  EXPECT_EQ(other.weight, 7.0);
  ASSERT_EQ(posture.yieldsTo.size(), 1u);
  EXPECT_EQ(posture.yieldsTo[0].frame, reach.frame);
  posture.weight = 0.01;  // a weak one takes nothing
  weigh(arm);
  EXPECT_EQ(reach.weight, alone);
  posture.weight = 300.0;
  posture.startTime = 2.0;
  reach.endTime = 2.0;  // not at one time
  weigh(arm);
  EXPECT_EQ(reach.weight, alone);
  EXPECT_TRUE(posture.yieldsTo.empty());
  reach.weight = 5.0;
  reach.endTime = kInfinity;
  weigh(arm);
  EXPECT_EQ(reach.weight, 5.0);  // somebody has changed it
}

TEST(DefaultWeight, JointsOfAPostureCountWhereTheyMoveTheLink) {
  RobotScene arm("arm");
  gdd::Reach& forearm = arm.addReach("forearm", kPlace);
  gdd::Reach& hand = arm.addReach("hand", kPlace);
  const double alone = hand.weight;
  auto wrist = std::make_unique<gdd::JointPosture>();
  wrist->targets = {gdd::jointTarget(arm.model, "wrist_pitch", 0.1)};
  wrist->weight = 50.0;
  arm.controller.goals.push_back(std::move(wrist));
  weigh(arm);
  EXPECT_EQ(hand.weight, 50.0 * alone);
  EXPECT_EQ(forearm.weight, alone);
}

}  // namespace
}  // namespace softgauss::test
