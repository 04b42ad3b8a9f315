// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/summary.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "sample_goals.hpp"
#include "softgauss/io/explain.hpp"
#include "softgauss/io/figure_text.hpp"

namespace softgauss::io {
namespace {

using nlohmann::ordered_json;

/// 100 steps whose numbers are 1 to 100, and a final state.
Summary sampleSummary(const Model& m) {
  Summary summary(m);
  StepRecord r;
  r.q = m.q0;
  r.v = r.a = r.u = VectorX::Zero(m.nv);
  for (int i = 1; i <= 100; ++i) {
    r.time = 0.002 * (i - 1);
    r.forwardUs = r.gddUs = r.stepUs = i;
    r.constraints = r.iterations = r.dualUpdates = i;
    r.physicsViolation = r.gddViolation = r.stationarity = i;
    r.energy = 10.0 - 0.01 * i;
    r.maxPenetration = i == 50 ? 0.003 : 0.001;
    r.u[6] = i == 20 ? -4.0 : 1.0;
    summary.addStep(r);
  }
  r.time = 0.2;
  r.energy = 3.0;
  summary.finish(r);
  summary.version = "1.2.3";
  summary.wallSeconds = 0.05;
  summary.effects = {"gravity"};
  summary.goals = {{.name = "reach arm", .initialError = 0.5, .finalError = 0.05}};
  return summary;
}

std::vector<std::string> keysOf(const ordered_json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

TEST(Summary, OptionsAreThoseOfTheModel) {
  Model model = sampleModel();
  model.options.cone = Cone::elliptic;
  model.options.impedanceRatio = 4.0;
  model.options.exactDiagonal = true;
  const ordered_json options = ordered_json::parse(Summary(model).json())["options"];
  EXPECT_EQ(options["cone"], "elliptic");
  EXPECT_EQ(options["impedance_ratio"], 4.0);
  EXPECT_EQ(options["exact_diagonal"], true);
}

TEST(Summary, HasTheKeysOfTheInterfaceInOrder) {
  const ordered_json json = ordered_json::parse(sampleSummary(sampleModel()).json());
  using Keys = std::vector<std::string>;
  EXPECT_EQ(keysOf(json), (Keys{"format",
                                "version",
                                "origin",
                                "model",
                                "options",
                                "outcome",
                                "verdict",
                                "bases",
                                "steps",
                                "state_hash",
                                "simulated_s",
                                "wall_s",
                                "real_time_factor",
                                "effects",
                                "time_us",
                                "constraints",
                                "iterations",
                                "dual_updates",
                                "physics_violation",
                                "gdd_violation",
                                "stationarity",
                                "realised",
                                "gdd_minima",
                                "fallbacks",
                                "goals",
                                "energy_J",
                                "max_penetration_m",
                                "max_control_ratio",
                                "control_ratios",
                                "warnings",
                                "mechanisms"}));
  EXPECT_EQ(keysOf(json["model"]), (Keys{"name", "links", "dof", "actuated", "mass_kg"}));
  EXPECT_EQ(keysOf(json["options"]),
            (Keys{"timestep_s", "integrator", "step_doubling", "tolerance", "cone",
                  "impedance_ratio", "exact_diagonal", "without", "gdd_solver", "control_cost"}));
  EXPECT_EQ(keysOf(json["time_us"]), (Keys{"forward", "gdd", "step"}));
  for (const auto& [key, value] : json["time_us"].items())
    EXPECT_EQ(keysOf(value), (Keys{"mean", "p50", "p95"})) << key;
  for (const char* key : {"constraints", "iterations", "dual_updates", "physics_violation",
                          "gdd_violation", "stationarity"})
    EXPECT_EQ(keysOf(json[key]), (Keys{"p50", "p95", "max"})) << key;
  EXPECT_EQ(keysOf(json["goals"][0]),
            (Keys{"name", "unit", "initial_error_m", "final_error_m", "best_error_m", "best_time_s",
                  "judged_at_s", "reached_within", "reached", "reason", "held_back_by"}));
  EXPECT_EQ(keysOf(json["origin"]),
            (Keys{"command_line", "commit", "compiler", "processor", "files"}));
  EXPECT_EQ(keysOf(json["energy_J"]), (Keys{"initial", "final"}));
}

TEST(Summary, CountsAndMeasures) {
  const ordered_json json = ordered_json::parse(sampleSummary(sampleModel()).json());
  EXPECT_EQ(json["model"]["name"], "sample");
  EXPECT_EQ(json["model"]["links"], 2);
  EXPECT_EQ(json["model"]["dof"], 7);
  EXPECT_EQ(json["model"]["actuated"], 1);
  EXPECT_EQ(json["model"]["mass_kg"], 3.0);
  EXPECT_EQ(json["steps"], 100);
  EXPECT_DOUBLE_EQ(json["simulated_s"], 0.2);
  EXPECT_DOUBLE_EQ(json["real_time_factor"], 4.0);
  EXPECT_EQ(json["time_us"]["step"]["mean"], 50.5);
  EXPECT_EQ(json["time_us"]["step"]["p50"], 50.0);
  EXPECT_EQ(json["time_us"]["step"]["p95"], 95.0);
  EXPECT_EQ(json["constraints"]["max"], 100);
  EXPECT_TRUE(json["constraints"]["max"].is_number_integer());
  EXPECT_EQ(json["max_penetration_m"], 0.003);
  EXPECT_EQ(json["max_control_ratio"], 0.8);
  EXPECT_EQ(json["energy_J"]["initial"], 9.99);
  EXPECT_EQ(json["energy_J"]["final"], 3.0);
}

TEST(Summary, PercentilesAreByNearestRank) {
  const Series series{{5, 1, 4, 2, 3}};
  EXPECT_EQ(series.percentile(0.5), 3);
  EXPECT_EQ(series.percentile(0.95), 5);
  EXPECT_EQ(series.percentile(0.2), 1);
  EXPECT_EQ(Series{}.percentile(0.5), 0);
}

TEST(Summary, OfNoStepsAndOddNamesIsStillJson) {
  Model m = sampleModel();
  m.name = "caf\xe9 \"x\"";
  const ordered_json json = ordered_json::parse(Summary(m).json());
  EXPECT_EQ(json["steps"], 0);
  EXPECT_EQ(json["goals"], ordered_json::array());
}

TEST(Summary, IsWrittenOrRefused) {
  const TempFolder folder;
  const Summary summary = sampleSummary(sampleModel());
  summary.write(folder.path() / "s.json");
  EXPECT_GT(std::filesystem::file_size(folder.path() / "s.json"), 100u);
  EXPECT_THROW(summary.write(folder.path() / "none" / "s.json"), ModelError);
}

// Places have the unit in the keys, as other programs read them; other goals do not.
TEST(Summary, GoalsHaveTheirOwnUnits) {
  Summary summary(sampleModel());
  summary.goals.push_back(
      {.name = "contact_force hand", .unit = "N", .finalError = 3.0, .met = 2.0});
  const ordered_json goal = ordered_json::parse(summary.json())["goals"][0];
  EXPECT_EQ(goal["unit"], "N");
  EXPECT_EQ(goal["final_error"], 3.0);
  EXPECT_EQ(goal["reached"], false);
  EXPECT_FALSE(goal.contains("final_error_m"));
}

// Which joint is behind the largest ratio, and all others.
TEST(Summary, RatiosNameTheirJoints) {
  Summary summary = sampleSummary(sampleModel());
  summary.addControlRatio("winch", 0.3);
  summary.addControlRatio("winch", 0.9);
  summary.addControlRatio("winch", 0.1);
  const ordered_json json = ordered_json::parse(summary.json());
  EXPECT_EQ(json["max_control_ratio"], 0.9);
  EXPECT_EQ(json["control_ratios"].dump(), R"({"winch":0.9,"shoulder":0.8})");
}

TEST(SummaryTable, EndsInTheVerdict) {
  Summary summary = sampleSummary(sampleModel());
  EXPECT_TRUE(summary.table().ends_with("\ncompleted\n"));
  summary.verdict = {{"fell", "base b"}, {"not reached", "reach arm: 50 mm left"}};
  EXPECT_TRUE(
      summary.table().ends_with("\nfell:         base b\nnot reached:  reach arm: 50 mm left\n"))
      << summary.table();
  EXPECT_EQ(summary.facts()[0].second, "fell: base b");
}

// What the solver did is for who asks.
TEST(SummaryTable, TellsTheSolverInDetailsAlone) {
  const Summary summary = sampleSummary(sampleModel());
  EXPECT_EQ(summary.table().find("constraint rows"), std::string::npos);
  EXPECT_NE(summary.table(true).find("constraint rows"), std::string::npos);
  EXPECT_NE(summary.table().find("80 % of its limit, shoulder"), std::string::npos);
}

TEST(FigureText, LengthsFromAMetreOnAreInMetres) {
  EXPECT_EQ(lengthText(0.0004), "0.4 mm");
  EXPECT_EQ(lengthText(0.4125), "412 mm");
  EXPECT_EQ(lengthText(0.9996), "1 m");
  EXPECT_EQ(lengthText(19.62), "19.6 m");
  EXPECT_EQ(lengthText(-2.0), "-2 m");
  EXPECT_EQ(figureText(0.02, "rad"), "0.02 rad");
  EXPECT_EQ(figureText(0.02, "m"), "20 mm");
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(Explain, TellsWhatWasLoadedAndWhatIsOff) {
  const TempFolder folder;
  ExplainContext context;
  context.contents.emplace();
  const Model m =
      readUrdf(folder.write("r.urdf", with(kSampleUrdf, "</robot>", "<gazebo/></robot>")), {},
               &*context.contents)
          .build();
  context.filtered = {{"base", "arm", "overlap at the start", "by 3 mm"}};
  context.testedPairs = 0;
  const std::string text = explain(m, context);
  for (const char* part :
       {"2 links, 1 joint, 2 moving bodies", "7 degrees of freedom, 1 actuated", "3 kg",
        "'base' floats", "shoulder revolute arm", "-1 .. 1.5 rad", "5 N m", "box 1",
        "1 pair never tested: overlap at the start", "base - arm by 3 mm", "0 pairs may touch",
        "joint_limit    1 joint range, 'shoulder'", "ignored: 1 <gazebo>"})
    EXPECT_TRUE(contains(text, part)) << part << "\n" << text;
}

// Names to write behind --reach and --q0; and costs that a trial cannot tell from none.
TEST(Explain, ListsWhatToAimAtAndLeavesOutNoise) {
  ExplainContext context;
  context.costs["gravity"] = {.us = -0.03};
  context.costs["coriolis"] = {.us = 1.234};
  const std::string text = explain(sampleModel(), context);
  for (const char* part :
       {"links, for --reach, --hold and goals\n    base, arm\n",
        "joints, for --q0, --torques and goals\n    shoulder\n", "< 0.1 µs", "1.23 µs"})
    EXPECT_TRUE(contains(text, part)) << part << "\n" << text;
  EXPECT_FALSE(contains(text, "-0.03"));
}

TEST(Explain, TellsHowManyRowsThereMayBe) {
  ExplainContext context;
  context.costs["gravity"] = {};
  context.costs["joint_limit"] = {.rows = 1};
  const std::string text = explain(sampleModel(), context);
  EXPECT_TRUE(std::regex_search(text, std::regex("joint_limit +1 +1 "))) << text;
}

TEST(EffectNotes, FollowTheSceneAndTheSwitches) {
  Model m = sampleModel();
  const auto note = [&](const std::string& name) {
    for (const EffectNote& n : effectNotes(m))
      if (n.name == name) return n;
    ADD_FAILURE() << name;
    return EffectNote{};
  };
  EXPECT_EQ(effectNotes(m).size(), 15u);
  EXPECT_TRUE(note("gravity").on);
  EXPECT_TRUE(note("self_collision").on);
  EXPECT_FALSE(note("ground_contact").on);
  EXPECT_FALSE(note("spring").asked);
  EXPECT_TRUE(note("dry_friction").on);
  m.options.effects.remove(Effect::damping);
  EXPECT_FALSE(note("damping").on);
  EXPECT_TRUE(contains(note("damping").reason, "switched off"));
  m.options.gravity.setZero();
  EXPECT_EQ(note("gravity").reason, "gravity is zero");
}

// However long a run, its summary takes the same memory; what is kept is spread evenly over it.
TEST(Series, TakesNoMoreMemoryThanItMay) {
  Series series;
  constexpr int kCount = 1000003;
  double sum = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double value = static_cast<double>(7919LL * i % kCount);  // each of 0 … kCount − 1 once
    series.add(value);
    sum += value;
    ASSERT_LT(series.values.size(), Series::kMost);
  }
  EXPECT_LE(series.values.capacity(), Series::kMost);
  EXPECT_GE(series.values.size(), Series::kMost / 4);
  EXPECT_DOUBLE_EQ(series.mean(), sum / kCount);
  EXPECT_EQ(series.max(), kCount - 1.0);
  // Shares of a sample err by its discrepancy, here far below one in a hundred.
  for (const double share : {0.05, 0.5, 0.95})
    EXPECT_NEAR(series.percentile(share) / kCount, share, 0.01) << share;
}

}  // namespace
}  // namespace softgauss::io
