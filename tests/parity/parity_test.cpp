// SPDX-License-Identifier: Apache-2.0
/// This engine beside MuJoCo: every number of a state, and free runs, against recorded logs.
///
/// docs/mujoco_parity.md tells what is compared, lists the scenes with the measured figures (each
/// test leaves its own as properties in --gtest_output=json) and says where the engines differ by
/// design. The bounds are those of that page; none is loosened for one scene.

#include <gtest/gtest.h>

#include <cstdio>

#include "collision/scene_contacts.hpp"
#include "engine/step/inverse.hpp"
#include "tests/parity/comparison.hpp"
#include "tests/parity/reference_log.hpp"
#include "tests/support/scene.hpp"
#include "tests/support/tolerance.hpp"

namespace softgauss::test {
namespace {

constexpr double kSmooth = 1e-10;     // M and bias, relative
constexpr double kContact = 1e-9;     // points [m], normals, distances [m]
constexpr double kRows = 1e-9;        // J, a_ref, D, relative
constexpr double kForward = 1e-7;     // forces and accelerations of two converged solvers
constexpr double kInverse = 1e-9;     // inverse dynamics, relative
constexpr double kTrajectory = 1e-6;  // 1 s of a free run [m, rad, m/s, rad/s]

/// What a free run is held to.
enum class Run {
  same,      ///< kTrajectory: contact geometry is analytic in both engines
  halfStep,  ///< the difference of MuJoCo from itself at half the step
};

struct ParityCase {
  const char* log;
  Run run = Run::same;
};
void PrintTo(const ParityCase& c, std::ostream* out) { *out << c.log; }

const ParityCase kCases[] = {
    {"random_tree_fixed"}, {"random_tree_floating"}, {"random_tree_large"},
    {"damped_chain"},      {"free_chain"},           {"tumbling_box"},
};

class Parity : public testing::TestWithParam<ParityCase> {
 protected:
  Parity()
      : log_(referenceLog(GetParam().log)),
        scene_(log_.model, std::make_shared<collision::SceneContacts>(log_.model)) {}

  /// Everything up to the rows, at a recorded state.
  void moveTo(const ReferenceState& reference) {
    scene_.state = State(scene_.model);
    scene_.state.q = reference.q;
    scene_.state.v = reference.v;
    scene_.input.tau = reference.force;
    ASSERT_EQ(scene_.stages(), SolveStatus::converged);
  }

  /// A figure for the table of docs/mujoco_parity.md.
  void report(const std::string& what, double figure) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1e", figure);
    RecordProperty(what, text);
  }

  const ReferenceLog& log_;
  Scene scene_;
};

TEST_P(Parity, SmoothDynamics) {
  double M = 0.0, bias = 0.0, acceleration = 0.0;
  for (const ReferenceState& reference : log_.states) {
    moveTo(reference);
    M = std::max(M, relativeDifference(scene_.data->inertia.M.dense(), reference.M));
    bias = std::max(bias, relativeDifference(scene_.data->forces.bias, reference.bias));
    TreeFactor factor;
    ASSERT_TRUE(factor.compute(scene_.data->inertia.M));
    VectorX a = scene_.data->forces.net;
    factor.solve(a);
    acceleration = std::max(acceleration, relativeDifference(a, reference.smoothAcceleration));
  }
  EXPECT_SMALL(M, kSmooth);
  EXPECT_SMALL(bias, kSmooth);
  EXPECT_SMALL(acceleration, kSmooth);
  report("M", M);
  report("bias", bias);
  report("a_smooth", acceleration);
}

TEST_P(Parity, Rows) {
  ContactDifference contacts;
  RowDifference rows;
  std::size_t count = 0;
  for (const ReferenceState& reference : log_.states) {
    moveTo(reference);
    const ContactDifference c =
        compareContacts(scene_.model, scene_.data->contacts, reference.contacts);
    ASSERT_FALSE(c.unmatched) << *c.unmatched;
    contacts.position = std::max(contacts.position, c.position);
    contacts.normal = std::max(contacts.normal, c.normal);
    contacts.distance = std::max(contacts.distance, c.distance);

    const RowDifference r = compareRows(rowsOf(scene_.model, *scene_.data), reference.rows);
    ASSERT_FALSE(r.unmatched) << *r.unmatched;
    rows.J = std::max(rows.J, r.J);
    rows.D = std::max(rows.D, r.D);
    rows.reference = std::max(rows.reference, r.reference);
    count = std::max(count, reference.rows.size());
  }
  EXPECT_SMALL(contacts.position, kContact);
  EXPECT_SMALL(contacts.normal, kContact);
  EXPECT_SMALL(contacts.distance, kContact);
  EXPECT_SMALL(rows.J, kRows);
  EXPECT_SMALL(rows.D, kRows);
  EXPECT_SMALL(rows.reference, kRows);
  RecordProperty("rows", std::to_string(count));
  report("J", rows.J);
  report("D", rows.D);
  report("a_ref", rows.reference);
}

TEST_P(Parity, ForwardDynamics) {
  double acceleration = 0.0, force = 0.0;
  for (const ReferenceState& reference : log_.states) {
    moveTo(reference);
    ASSERT_EQ(scene_.forward(), SolveStatus::converged);
    acceleration =
        std::max(acceleration, relativeDifference(scene_.data->forward.a, reference.acceleration));
    const RowDifference r = compareRows(rowsOf(scene_.model, *scene_.data), reference.rows);
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
    inverseDynamics(scene_.model, reference.inverseAcceleration, *scene_.data, tau);
    worst = std::max(worst, relativeDifference(tau, reference.inverseForce));
  }
  EXPECT_SMALL(worst, kInverse);
  report("inverse", worst);
}

TEST_P(Parity, Trajectory) {
  const ReferenceTrajectory& reference = log_.trajectory("Euler", false);
  const ReferenceTrajectory& finer = log_.trajectory("Euler", true);
  const int stride = static_cast<int>(std::lround(reference.every / reference.timestep));
  scene_.state.q = reference.q[0];
  scene_.state.v = reference.v[0];
  scene_.input.tau = log_.force;
  double worst = 0.0, ofHalfStep = 0.0;
  for (std::size_t i = 0; i < reference.q.size(); ++i) {
    const Model& model = scene_.model;
    ofHalfStep = std::max(
        ofHalfStep, stateDifference(model, finer.q[i], finer.v[i], reference.q[i], reference.v[i]));
    const double difference =
        stateDifference(model, scene_.state.q, scene_.state.v, reference.q[i], reference.v[i]);
    worst = std::max(worst, difference);
    if (GetParam().run == Run::halfStep) {
      EXPECT_LE(difference, ofHalfStep) << "after " << static_cast<double>(i) * reference.every;
    }
    for (int k = 0; k < stride; ++k) ASSERT_EQ(scene_.step(), SolveStatus::converged);
  }
  if (GetParam().run == Run::same) {
    EXPECT_SMALL(worst, kTrajectory);
  }
  report("run", worst);
  report("half_step", ofHalfStep);
}

INSTANTIATE_TEST_SUITE_P(Mujoco, Parity, testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.log); });

}  // namespace
}  // namespace softgauss::test
