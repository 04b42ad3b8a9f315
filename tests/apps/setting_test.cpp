// SPDX-License-Identifier: Apache-2.0
/// The choice of a setting, on made-up runs whose errors and times are known in closed form.

#include <cmath>

#include "apps/shared/run_choice.hpp"
#include "tests/apps/process.hpp"
#include "tests/support/sample_models.hpp"

namespace softgauss::test {
namespace {

using app::Setting;
using app::TrialRun;

/// A slide of 1 kg whose only error is what `error` says, in metres at a time.
class MadeUp {
 public:
  std::function<double(const Setting&, double time)> error;
  std::function<double(const Setting&)> price = [](const Setting& s) { return 1e-3 * s.steps; };
  std::function<double(const Setting&)> lostAt = [](const Setting&) { return kInfinity; };
  double spent = 0.0;
  bool touches = true;
  double longestStep = 0.032;  ///< [s]

  MadeUp() {
    ModelBuilder builder("slide");
    LinkSpec world;
    world.name = "world";
    builder.link(world).link(boxLink("mass", 1.0, {0.1, 0.1, 0.1}));
    builder.joint(
        jointSpec("slide", JointType::prismatic, "world", "mass", Transform{}, Vector3::UnitX()));
    model_.emplace(builder.build());
  }

  app::TrialScene over(double simulated) {
    app::TrialScene scene;
    scene.model = &*model_;
    scene.simulated = simulated;
    scene.longestStep = longestStep;
    scene.run = [this, simulated](const Setting& setting, double mostSeconds) {
      TrialRun run;
      run.touches = touches;
      const double needed = price(setting) * simulated;
      run.seconds = std::min(needed, mostSeconds);
      spent += run.seconds;
      run.late = needed > mostSeconds;
      if (run.late) return run;
      run.lostAt = lostAt(setting);
      if (run.lostAt < simulated) return run;
      run.finite = true;
      for (double t = 0.032; t < simulated + 1e-9; t += 0.032) {
        State state(*model_);
        state.q[0] = error(setting, t);
        run.samples.push_back(state);
      }
      return run;
    };
    return scene;
  }

 private:
  std::optional<Model> model_;
};

/// An error of the order of each method; of a hundredth of the tolerance with error control.
double ofOrder(const Setting& s) {
  const double h = 1.0 / s.steps;
  switch (s.integrator) {
    case Integrator::rungeKutta4:
      return std::pow(h, 4);
    case Integrator::implicitMidpoint:
      return h * h;
    case Integrator::dormandPrince:
      return 1e-2 * s.integrationTolerance;
    default:
      return s.doubling ? 1e-2 * s.integrationTolerance : h;
  }
}

// Steps beyond half a time constant change contacts and limits, where there are any; where none of
// them acts in the reference, the longest step that is accurate enough is the cheapest.
TEST(ChooseSetting, LongStepsAreTriedWhereNothingTouches) {
  for (const bool touches : {false, true}) {
    MadeUp runs;
    runs.error = [](const Setting& s, double) { return 1e-6 / s.steps; };
    runs.touches = touches;
    runs.longestStep = 0.008;
    const app::Choice choice = app::chooseSetting(1e-3, runs.over(1.0));
    ASSERT_TRUE(choice.found);
    EXPECT_EQ(choice.setting.steps, touches ? 4 : 1);
  }
}

TEST(ChooseSetting, NamesTheReferencesThatAreNearest) {
  MadeUp scene;
  // The first pair differs by a metre, the second by 0.1 m, the third by 0.3 m, the last by 5 m.
  scene.error = [](const Setting& s, double) {
    if (s.integrator == Integrator::dormandPrince)
      return s.steps == 2 ? 1.0 : s.steps == 8 ? 0.1 : 0.0;
    return s.integrator == Integrator::rungeKutta4 ? 0.3 * s.steps / 128 : 5.0 * s.steps / 512;
  };
  const app::Choice choice = app::chooseSetting(1e-3, scene.over(1.0));
  EXPECT_FALSE(choice.referenced);
  EXPECT_FALSE(choice.late);
  EXPECT_NEAR(choice.error, 0.1, 1e-12);
}

// A run that overflows is not one that takes too long: the shorter trial of chooseForRun() is not
// made, and the time is told.
TEST(ChooseSetting, TellsOverflowFromLateness) {
  MadeUp scene;
  scene.error = [](const Setting&, double) { return 0.0; };
  scene.lostAt = [](const Setting& s) {
    return s.integrator == Integrator::dormandPrince ? 0.7 : 0.9;
  };
  const app::RunChoice run = app::chooseForRun(
      1e-3, 10.0, [&](double simulated) { return scene.over(simulated); }, 1e9);
  EXPECT_FALSE(run.choice.found);
  EXPECT_FALSE(run.choice.referenced);
  EXPECT_FALSE(run.choice.late);
  EXPECT_TRUE(run.whole);
  EXPECT_EQ(run.choice.lostAt, 0.7);
}

TEST(ChooseSetting, EndsAtItsBudgetWithTheBestSoFar) {
  MadeUp scene;
  scene.error = [](const Setting& s, double) { return ofOrder(s); };
  const app::Choice free = app::chooseSetting(1e-3, scene.over(1.0));
  ASSERT_TRUE(free.found);
  EXPECT_LE(free.error, 1e-3);
  app::TrialScene bounded = scene.over(1.0);
  bounded.mostSeconds = 0.5 * free.trialSeconds;
  scene.spent = 0.0;
  const app::Choice choice = app::chooseSetting(1e-3, bounded);
  EXPECT_TRUE(choice.found);
  EXPECT_LE(choice.error, 1e-3);
  EXPECT_GT(choice.price, 0.0);
  EXPECT_LE(scene.spent, bounded.mostSeconds * (1.0 + 1e-12));
  bounded.mostSeconds = 0.0;
  EXPECT_TRUE(app::chooseSetting(1e-3, bounded).late);
}

TEST(ChooseForRun, TriesTheWholeRunWhereItMay) {
  MadeUp scene;
  scene.error = [](const Setting& s, double t) { return ofOrder(s) * t * t; };
  const app::RunChoice run = app::chooseForRun(
      1e-3, 10.0, [&](double simulated) { return scene.over(simulated); }, 1e9);
  ASSERT_TRUE(run.choice.found);
  EXPECT_TRUE(run.whole);
  EXPECT_EQ(run.tried, 10.0);
  EXPECT_LE(run.choice.error, 1e-3);
  // Root mean square of t² over the run: 10² √(1/5).
  EXPECT_NEAR(run.choice.error / scene.error(run.choice.setting, 10.0), std::sqrt(0.2), 0.01);
}

// Errors that grow as t and as t²: the one that is expected at the end is the one that is there,
// and it is not far below what was asked for. 3 %: the 2 s of the made-up trial end with its sample
// at 1.984 s.
TEST(ChooseForRun, AimsAtTheEndOfARunThatIsTooDear) {
  for (const double power : {1.0, 2.0}) {
    MadeUp scene;
    scene.error = [&](const Setting& s, double t) { return ofOrder(s) * std::pow(t, power); };
    const app::RunChoice run = app::chooseForRun(
        1e-3, 10.0, [&](double simulated) { return scene.over(simulated); }, 0.0);
    ASSERT_TRUE(run.choice.found);
    EXPECT_FALSE(run.whole);
    EXPECT_EQ(run.tried, app::kShortTrial);
    const double atEnd = scene.error(run.choice.setting, 10.0);
    EXPECT_NEAR(run.atEnd / atEnd, 1.0, 0.03);
    EXPECT_LE(atEnd, 1e-3);
    EXPECT_GE(atEnd, 1e-4);
  }
}

TEST(ChooseForRun, PromisesNothingOfChaos) {
  MadeUp scene;
  scene.error = [](const Setting& s, double t) { return 1e-3 * ofOrder(s) * std::exp(5.0 * t); };
  const app::RunChoice run = app::chooseForRun(
      1e-2, 10.0, [&](double simulated) { return scene.over(simulated); }, 0.0);
  EXPECT_FALSE(run.choice.found);
  EXPECT_TRUE(run.growth.chaotic);
  EXPECT_NEAR(run.growth.rate, 5.0, 0.1);
}

// What swings through zero is not taken for chaos.
TEST(Growth, IsThatOfTheErrors) {
  std::vector<double> swinging, steady;
  for (int k = 1; k <= 62; ++k) {
    const double t = 0.032 * k;
    swinging.push_back(1e-4 * t * t * std::abs(std::sin(9.0 * t)));
    steady.push_back(1e-4 * std::pow(t, 1.5));
  }
  const app::Growth a = app::growthOf(swinging, 1.984), b = app::growthOf(steady, 1.984);
  EXPECT_FALSE(a.chaotic);
  EXPECT_NEAR(a.power, 2.0, 0.5);
  EXPECT_FALSE(b.chaotic);
  EXPECT_NEAR(b.power, 1.5, 0.01);
  EXPECT_NEAR(b.at(10.0), 1e-4 * std::pow(10.0, 1.5), 3e-5);
  // Nothing is off: nothing grows.
  EXPECT_EQ(app::growthOf(std::vector<double>(62, 0.0), 2.0).at(10.0), 0.0);
}

}  // namespace
}  // namespace softgauss::test
