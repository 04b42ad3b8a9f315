// SPDX-License-Identifier: Apache-2.0
/// This engine beside MuJoCo: every number of a state, and free runs, against recorded logs.
///
/// docs/mujoco_parity.md tells what is compared, lists the scenes with the measured figures (each
/// test leaves its own as properties in --gtest_output=json) and says where the engines differ by
/// design. The bounds are those of that page; none is loosened for one scene.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/dynamics/energy.hpp"
#include "softgauss/engine/step/inverse.hpp"
#include "tests/parity/comparison.hpp"
#include "tests/parity/free_run.hpp"
#include "tests/parity/reference_log.hpp"
#include "tests/support/scene.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

constexpr double kSmooth = 1e-10;     // M and bias, relative
constexpr double kContact = 1e-9;     // points [m], normals, distances [m]
constexpr double kRows = 1e-9;        // J, a_ref, D, relative
constexpr double kInverse = 1e-9;     // inverse dynamics, relative
constexpr double kTrajectory = 1e-6;  // 1 s of a free run [m, rad, m/s, rad/s]

/// Whose contact points serve for the rows and what follows from them. Where the two engines choose
/// other points by design, rows and forces are compared at the points of the log.
enum class Points { ours, logged };

/// What a free run, which always has our own points, is held to.
enum class Run {
  same,      ///< kTrajectory
  halfStep,  ///< the difference of MuJoCo from itself at half the step
  apart,     ///< ParityCase::apart, since the points are chosen otherwise
};

struct ParityCase {
  const char* log;
  Points points = Points::ours;
  Run run = Run::same;
  double apart = 0.0;
};
void PrintTo(const ParityCase& c, std::ostream* out) { *out << c.log; }

const ParityCase kCases[] = {
    {"random_tree_fixed"},
    {"random_tree_floating"},
    {"random_tree_large"},
    {"random_trees_heap"},
    {"damped_chain"},
    {"free_chain"},
    {"tumbling_box"},
    {"pendulum_limit"},
    {"pendulum_limit_soft"},
    {"pendulum_limit_stiff"},
    {"pendulum_limit_direct"},
    {"slider_limit"},
    {"slider_spring"},
    {"pendulum_spring"},
    {"slider_dry_friction"},
    {"pendulum_dry_friction"},
    {"chain_dry_friction"},
    {"mimic_pair"},
    {"coupled_pair"},
    {"connect_hanging"},
    {"weld_hanging"},
    {"weld_soft"},
    {"four_bar_connect"},
    {"four_bar_redundant"},
    {"four_bar_weld"},
    {"sphere_condim_1"},
    {"sphere_condim_3"},
    {"capsule_condim_1"},
    {"capsule_condim_3"},
    {"box_condim_1"},
    {"box_condim_3"},
    {"cylinder_condim_1", Points::logged, Run::halfStep},
    {"cylinder_condim_3", Points::logged, Run::halfStep},
    {"cylinder_rolling"},
    {"sphere_condim_4"},
    {"sphere_condim_6"},
    {"capsule_condim_4"},
    {"capsule_condim_6"},
    {"box_condim_4"},
    {"box_condim_6"},
    {"cylinder_condim_4", Points::logged, Run::halfStep},
    {"cylinder_condim_6", Points::logged, Run::halfStep},
    {"elliptic_sphere_condim_3"},
    {"elliptic_sphere_condim_4"},
    {"elliptic_sphere_condim_6"},
    {"elliptic_box_condim_3"},
    {"elliptic_box_condim_4"},
    {"elliptic_box_condim_6"},
    {"friction_0_1"},
    {"friction_0_5"},
    {"friction_1"},
    {"friction_2"},
    {"box_incline"},
    {"box_integrators"},
    {"softness_mixed"},
    {"softness_box"},
    {"softness_stiff"},
    {"softness_direct"},
    {"mix_weight"},
    {"mix_priority"},
    {"contact_margin"},
    {"impedance_ratio"},
    {"pair_sphere_sphere"},
    {"pair_sphere_capsule"},
    {"pair_capsule_capsule", Points::logged},
    {"pair_sphere_box"},
    {"pair_sphere_cylinder"},
    {"pair_capsule_box", Points::logged, Run::apart, 0.5},
    {"pair_box_box", Points::logged, Run::apart, 0.1},
    {"box_stack", Points::logged, Run::apart, 0.01},
    {"humanoid_standing"},
    {"humanoid_falling"},
    {"humanoid_lying"},
    {"hand_grasp", Points::logged, Run::halfStep},
    {"hand_fingers"},
    {"arm_push", Points::logged, Run::apart, 0.5},
    {"arm_push_ball"},
    {"elliptic_random_trees_heap"},
    {"elliptic_chain_dry_friction"},
    {"elliptic_capsule_condim_3"},
    {"elliptic_cylinder_condim_3", Points::logged, Run::halfStep},
    {"elliptic_cylinder_rolling"},
    {"elliptic_capsule_condim_4"},
    {"elliptic_capsule_condim_6"},
    {"elliptic_cylinder_condim_4", Points::logged, Run::halfStep},
    {"elliptic_cylinder_condim_6", Points::logged, Run::halfStep},
    {"elliptic_friction_0_1"},
    {"elliptic_friction_0_5"},
    {"elliptic_friction_1"},
    {"elliptic_friction_2"},
    {"elliptic_box_incline"},
    {"elliptic_box_integrators"},
    {"elliptic_softness_mixed"},
    {"elliptic_softness_box"},
    {"elliptic_softness_stiff"},
    {"elliptic_softness_direct"},
    {"elliptic_mix_weight"},
    {"elliptic_mix_priority"},
    {"elliptic_contact_margin"},
    {"elliptic_impedance_ratio"},
    {"elliptic_pair_sphere_sphere"},
    {"elliptic_pair_sphere_capsule"},
    {"elliptic_pair_capsule_capsule", Points::logged},
    {"elliptic_pair_sphere_box"},
    {"elliptic_pair_sphere_cylinder"},
    {"elliptic_pair_capsule_box", Points::logged, Run::apart, 0.5},
    {"elliptic_pair_box_box", Points::logged, Run::apart, 0.1},
    {"elliptic_box_stack", Points::logged, Run::apart, 0.01},
    {"elliptic_humanoid_standing"},
    {"elliptic_humanoid_falling"},
    {"elliptic_humanoid_lying"},
    {"elliptic_hand_grasp", Points::ours, Run::apart, 1.0},
    {"elliptic_hand_fingers"},
    {"elliptic_arm_push", Points::logged, Run::apart, 0.5},
    {"elliptic_arm_push_ball"},
    {"exact_pendulum_limit"},
    {"exact_coupled_pair"},
    {"exact_weld_hanging"},
    {"exact_connect_hanging"},
    {"exact_chain_dry_friction"},
    {"exact_box_condim_1"},
    {"exact_box_condim_6"},
    {"exact_humanoid_lying"},
    {"exact_elliptic_box_condim_6"},
    {"exact_elliptic_hand_fingers"},
};

TEST(ParityLogs, EachIsCompared) {
  std::set<std::string> known;
  for (const ParityCase& c : kCases) EXPECT_TRUE(known.insert(c.log).second) << c.log;
  const std::vector<std::string> names = referenceLogNames();
  EXPECT_EQ(known, std::set<std::string>(names.begin(), names.end()));
}

class Parity : public testing::TestWithParam<ParityCase> {
 protected:
  Parity()
      : log_(referenceLog(GetParam().log)),
        ours_(std::make_shared<collision::SceneContacts>(log_.model)),
        logged_(std::make_shared<FixedContacts>()),
        scene_(log_.model, ours_) {}

  /// Everything up to the rows, at a recorded state.
  void moveTo(const ReferenceState& reference, Points points) {
    scene_.state = State(scene_.model);
    scene_.state.q = reference.q;
    scene_.state.v = reference.v;
    scene_.input.tau = reference.force;
    scene_.input.wrenches = reference.wrenches;
    logged_->points = loggedContacts(scene_.model, reference.contacts);
    scene_.contacts = ours_;
    if (points == Points::logged) scene_.contacts = logged_;
    ASSERT_EQ(scene_.stages(), SolveStatus::converged);
  }
  void moveTo(const ReferenceState& reference) { moveTo(reference, GetParam().points); }

  /// A figure for the table of docs/mujoco_parity.md.
  void report(const std::string& what, double figure) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1e", figure);
    RecordProperty(what, text);
  }

  const ReferenceLog& log_;
  std::shared_ptr<ContactSource> ours_;
  std::shared_ptr<FixedContacts> logged_;
  Scene scene_;
};

TEST_P(Parity, SmoothDynamics) {
  double M = 0.0, bias = 0.0, acceleration = 0.0;
  for (const ReferenceState& reference : log_.states) {
    moveTo(reference);
    M = std::max(M, relativeDifference(scene_.data->inertia.M.dense(), reference.M, 0.0));
    bias = std::max(
        bias, relativeDifference(scene_.data->forces.bias, reference.bias, smallForce(reference)));
    TreeFactor factor;
    ASSERT_TRUE(factor.compute(scene_.data->inertia.M));
    VectorX a = scene_.data->forces.net;
    factor.solve(a);
    acceleration = std::max(
        acceleration, relativeDifference(a, reference.smoothAcceleration, kSmallAcceleration));
  }
  EXPECT_SMALL(M, kSmooth);
  EXPECT_SMALL(bias, kSmooth);
  EXPECT_SMALL(acceleration, kSmooth);
  report("M", M);
  report("bias", bias);
  report("a_smooth", acceleration);
}

TEST_P(Parity, Totals) {
  double energy = 0.0, centre = 0.0, momentum = 0.0;
  for (const ReferenceState& reference : log_.states) {
    moveTo(reference);
    const Totals& totals = reference.totals;
    const Energy ours =
        computeEnergy(scene_.model, scene_.data->kinematics, reference.q, reference.v);
    const Eigen::Vector2d energies(ours.potential, ours.kinetic);
    energy = std::max(
        energy,
        relativeDifference(energies, Eigen::Vector2d(totals.potential, totals.kinetic), 1.0));
    const Vector3 c = centerOfMass(scene_.model, scene_.data->kinematics);
    centre = std::max(centre, relativeDifference(c, totals.centreOfMass, 1.0));
    const Momentum m = computeMomentum(scene_.model, scene_.data->kinematics);
    momentum = std::max(momentum, relativeDifference(m.linear, totals.momentum, totals.mass));
    momentum = std::max(momentum, relativeDifference(m.angular - c.cross(m.linear),
                                                     totals.angularMomentum, totals.mass));
    EXPECT_SMALL(scene_.model.totalMass() / totals.mass - 1.0, kSmooth);
  }
  EXPECT_SMALL(energy, kSmooth);
  EXPECT_SMALL(centre, kSmooth);
  EXPECT_SMALL(momentum, kSmooth);
  report("totals", std::max({energy, centre, momentum}));
}

TEST_P(Parity, ContactPoints) {
  double position = 0.0, normal = 0.0, distance = 0.0, acceleration = 0.0;
  bool same = true;
  for (const ReferenceState& reference : log_.states) {
    moveTo(reference, Points::ours);
    const ContactDifference c =
        compareContacts(scene_.model, scene_.data->contacts, reference.contacts);
    same = same && !c.unmatched;
    if (GetParam().points == Points::ours) {
      ASSERT_FALSE(c.unmatched) << *c.unmatched;
    }
    position = std::max(position, c.position);
    normal = std::max(normal, c.normal);
    distance = std::max(distance, c.distance);
    ASSERT_EQ(scene_.forward(), SolveStatus::converged);
    acceleration = std::max(
        acceleration,
        relativeDifference(scene_.data->forward.a, reference.acceleration, kSmallAcceleration));
  }
  same = same && std::max({position, normal, distance}) <= kContact;
  if (GetParam().points == Points::ours) {
    EXPECT_SMALL(position, kContact);
    EXPECT_SMALL(normal, kContact);
    EXPECT_SMALL(distance, kContact);
    report("points", std::max({position, normal, distance}));
  } else {
    EXPECT_FALSE(same) << "the points are the same: compare rows at our own";
    RecordProperty("points", "other");
    report("a_elsewhere", acceleration);
  }
}

TEST_P(Parity, Rows) {
  RowDifference worst;
  std::size_t count = 0;
  for (const ReferenceState& reference : log_.states) {
    moveTo(reference);
    const RowDifference r =
        compareRows(rowsOf(scene_.model, *scene_.data), reference.rows, smallForce(reference));
    ASSERT_FALSE(r.unmatched) << *r.unmatched;
    worst.J = std::max(worst.J, r.J);
    worst.D = std::max(worst.D, r.D);
    worst.reference = std::max(worst.reference, r.reference);
    count = std::max(count, reference.rows.size());
  }
  EXPECT_SMALL(worst.J, kRows);
  EXPECT_SMALL(worst.D, kRows);
  EXPECT_SMALL(worst.reference, kRows);
  RecordProperty("rows", std::to_string(count));
  report("J", worst.J);
  report("D", worst.D);
  report("a_ref", worst.reference);
}

TEST_P(Parity, ForwardDynamics) {
  double acceleration = 0.0, force = 0.0;
  for (const ReferenceState& reference : log_.states) {
    moveTo(reference);
    ASSERT_EQ(scene_.forward(), SolveStatus::converged);
    acceleration = std::max(
        acceleration,
        relativeDifference(scene_.data->forward.a, reference.acceleration, kSmallAcceleration));
    const RowDifference r =
        compareRows(rowsOf(scene_.model, *scene_.data), reference.rows, smallForce(reference));
    ASSERT_FALSE(r.unmatched) << *r.unmatched;
    force = std::max(force, r.force);
  }
  EXPECT_SMALL(acceleration, kForward);
  EXPECT_SMALL(force, kForward);
  report("a", acceleration);
  report("f", force);
}

TEST_P(Parity, InverseDynamics) {
  double worst = 0.0;
  VectorX tau;
  for (const ReferenceState& reference : log_.states) {
    moveTo(reference);
    // MuJoCo's result is the whole force, ours what is needed besides the wrenches.
    scene_.input.wrenches.clear();
    ASSERT_EQ(scene_.stages(), SolveStatus::converged);
    inverseDynamics(scene_.model, reference.inverseAcceleration, *scene_.data, tau);
    worst = std::max(worst, relativeDifference(tau, reference.inverseForce, smallForce(reference)));
  }
  EXPECT_SMALL(worst, kInverse);
  report("inverse", worst);
}

TEST_P(Parity, Trajectory) {
  const ReferenceTrajectory& reference = log_.trajectory("Euler", false);
  const ReferenceTrajectory& finer = log_.trajectory("Euler", true);
  scene_.input.tau = log_.force;
  const std::vector<double> run = runBeside(reference, scene_, Random(0), 0.0);
  double worst = *std::max_element(run.begin(), run.end()), ofHalfStep = 0.0;
  for (std::size_t i = 0; i < run.size(); ++i) {
    ofHalfStep = std::max(ofHalfStep, stateDifference(scene_.model, finer.q[i], finer.v[i],
                                                      reference.q[i], reference.v[i]));
    if (GetParam().run == Run::halfStep) {
      EXPECT_LE(run[i], ofHalfStep) << "after " << static_cast<double>(i) * reference.every;
    }
  }
  if (GetParam().run == Run::same) {
    EXPECT_SMALL(worst, kTrajectory);
  }
  if (GetParam().run == Run::apart) {
    worst = medianDifference(reference, scene_);
    EXPECT_SMALL(worst, GetParam().apart);
    EXPECT_GT(worst, ofHalfStep) << "no longer apart";
  }
  report("run", worst);
  report("half_step", ofHalfStep);
}

INSTANTIATE_TEST_SUITE_P(Mujoco, Parity, testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.log); });

}  // namespace
}  // namespace softgauss::test
