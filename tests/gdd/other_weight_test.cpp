// SPDX-License-Identifier: Apache-2.0
/// What goals leave with other weights: against a closed form, and without traces.

#include "softgauss/gdd/other_weight.hpp"

#include "tests/gdd/robot_scene.hpp"
#include "tests/support/matchers.hpp"

namespace softgauss::test {
namespace {

/// A slider of 2 kg along x, at rest between a posture at 0 and a place at 0.1 m.
struct TornSlider {
  static constexpr double kMass = 2.0, kPostureWeight = 1000.0;
  Model model = slidingCart(kMass);
  State state{model};
  Data data{model};
  gdd::GoalDirectedController controller{model};
  gdd::Reach* reach = nullptr;

  TornSlider() {
    state.q.setZero();
    auto place = std::make_unique<gdd::Reach>(model, "cart", Vector3(0.1, 0.0, 0.0));
    place->weight = 10.0;
    reach = place.get();
    controller.goals.push_back(std::move(place));
    auto posture = std::make_unique<gdd::Posture>(state.q);
    posture->weight = kPostureWeight;
    controller.goals.push_back(std::move(posture));
    gdd::weighDefaults(model, controller.goals);
    for (int i = 0; i < 1000; ++i) step();
  }
  void step() { ASSERT_FALSE(isRefused(controller.step(model, {}, state, data, nullptr))); }

  gdd::GoalError error() const {
    gdd::GoalError error;
    error.value = 0.1 - state.q[0];
    return error;
  }
  std::optional<double> leaves(double weight) {
    gdd::OtherWeight trial(model, controller);
    return trial.leaves(*reach, error(), reach->weight, weight, {}, state, nullptr);
  }
  /// w k_r e = w_p M k_p (0.1 − e) at rest.
  double atRest(double weight) const {
    const double held = kPostureWeight * kMass * gdd::Posture(state.q).stiffness;
    return 0.1 * held / (held + weight * reach->stiffness);
  }
};

// The trial ends where the error changes by 0.2 mm in a quarter of a second, and approaches its end
// at 10/s: a tenth of that is left.
TEST(OtherWeight, LeavesWhatTheClosedFormSays) {
  TornSlider s;
  EXPECT_NEAR(s.error().value, s.atRest(10.0), 2e-5);
  for (const double weight : {100.0, 1e3, 1e4, 1e5, 1e6}) {
    const std::optional<double> left = s.leaves(weight);
    ASSERT_TRUE(left);
    EXPECT_NEAR(*left, s.atRest(weight), 1e-4) << weight;
  }
}

TEST(OtherWeight, LeavesGoalsWeightsAndRunAsTheyWere) {
  TornSlider asked, other;
  ASSERT_TRUE(asked.leaves(1e4));
  EXPECT_EQ(asked.reach->weight, 10.0);
  ASSERT_EQ(asked.controller.goals.size(), 2u);
  EXPECT_EQ(asked.controller.goals[0].get(), asked.reach);
  for (int i = 0; i < 10; ++i) asked.step(), other.step();
  EXPECT_EQ(asked.state.q, other.state.q);
  EXPECT_EQ(asked.state.v, other.state.v);
}

// A default weight comes back with what yields to it.
TEST(OtherWeight, GivesADefaultWeightBack) {
  TornSlider s;
  s.controller.goals[0] = std::make_unique<gdd::Reach>(s.model, "cart", Vector3(0.1, 0.0, 0.0));
  s.reach = static_cast<gdd::Reach*>(s.controller.goals[0].get());
  gdd::weighDefaults(s.model, s.controller.goals);
  const auto& posture = static_cast<const gdd::Posture&>(*s.controller.goals[1]);
  const double before = s.reach->weight;
  ASSERT_EQ(posture.yieldsTo.size(), 1u);
  ASSERT_TRUE(s.leaves(3e4));
  EXPECT_EQ(s.reach->weight, before);
  EXPECT_TRUE(s.reach->defaultWeight.isAt(before));
  EXPECT_EQ(posture.yieldsTo.size(), 1u);
}

// e = c e_0/(c + w): a power of ten that leaves no more than is wanted, where a million times is
// enough, and ten times at least.
TEST(OtherWeight, TriesWhatTheEstimateAsksFor) {
  using gdd::OtherWeight;
  for (const double c : {1.0, 30.0, 5e3})
    for (const double now : {0.5, 10.0, 700.0}) {
      const double left = 0.1 * c / (c + now), wanted = 0.005;
      const double tried = OtherWeight::toTry(now, left, 0.1, wanted);
      EXPECT_LE(0.1 * c / (c + tried), wanted * (1.0 + 1e-9));
      EXPECT_EQ(std::round(std::log10(tried)), std::log10(tried)) << tried;
      EXPECT_GE(tried, 10.0 * now * (1.0 - 1e-12));
    }
  EXPECT_LE(OtherWeight::toTry(1.0, 0.1, 0.1, 0.005), OtherWeight::kMostRaised);
}

}  // namespace
}  // namespace softgauss::test
