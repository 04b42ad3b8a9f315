// SPDX-License-Identifier: Apache-2.0
/// gdd_benchmark on a few hundred records: it repeats itself, its replay takes the recorded steps,
/// and its statistics stay where they are.

#include <cstdio>
#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// The figures of a run, read from its --json file.
OrderedJson benchmark(std::vector<std::string> arguments) {
  const io::TempFolder folder;
  const std::string file = folder.path() / "figures.json";
  arguments.insert(arguments.end(), {"--robots", dataFile("robots"), "--json", file});
  const Outcome outcome = runProgram("gdd_benchmark", arguments);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  return OrderedJson::parse(readFile(file));
}

/// Without the clock's figures, whose keys end in _us.
OrderedJson withoutTimes(const OrderedJson& json) {
  if (!json.is_structured()) return json;
  OrderedJson rest = json.is_array() ? OrderedJson::array() : OrderedJson::object();
  for (const auto& [key, value] : json.items()) {
    if (json.is_array())
      rest.push_back(withoutTimes(value));
    else if (!key.ends_with("_us"))
      rest[key] = withoutTimes(value);
  }
  return rest;
}

TEST(GddBenchmark, SameSeedSameFigures) {
  const auto run = [](const char* seed) {
    return withoutTimes(benchmark({"--records", "600", "--passes", "1", "--seed", seed}));
  };
  const OrderedJson first = run("7");
  EXPECT_EQ(first, run("7"));
  EXPECT_NE(first["datasets"], run("8")["datasets"]);
}

// Otherwise the solvers are not measured on what happened.
TEST(GddBenchmark, ReplayTakesTheRecordedSteps) {
  const OrderedJson json = benchmark({"--records", "600", "--passes", "2"});
  ASSERT_EQ(json["datasets"].size(), 3u);
  for (const OrderedJson& dataset : json["datasets"]) {
    EXPECT_EQ(dataset["records"], 600);
    EXPECT_EQ(dataset["goals"], 2);
    EXPECT_EQ(dataset["passes"], 2);
    for (const OrderedJson& solver : dataset["solvers"])
      if (solver["name"] == dataset["recorder"]) {
        EXPECT_EQ(solver["controls_unlike_recorded"], 0);
      }
  }
}

TEST(GddBenchmark, ASolverIsAsGoodAsItself) {
  const char* const solver = "augmented-lagrangian";
  const OrderedJson json = benchmark({"--records", "300", "--passes", "1", "--models", "humanoid",
                                      "--solvers", std::string(solver) + "," + solver});
  const OrderedJson& comparison = json["datasets"][0]["comparisons"][0];
  EXPECT_EQ(comparison["equal"], 300);
  EXPECT_EQ(comparison["first_lower"], 0);
  EXPECT_EQ(comparison["second_lower"], 0);
}

/// What is asked of the figures of `json`.
void expectStatistics(const OrderedJson& json) {
  ASSERT_EQ(json["datasets"].size(), 9u);
  const struct {
    double median, most, certified;
  } asked[] = {{1, 3, 0.9999}, {2, 9, 0.999}, {4, 18, 0.999}};
  int place = 0;
  for (const OrderedJson& dataset : json["datasets"]) {
    const auto& bound = asked[place++ % 3];
    // Near-rigid contacts put nine in ten of a hand's minima on kinks (decision 0056): solver 2
    // takes twice the iterations, and solver 1 certifies about half of them.
    const bool hand = dataset["model"] == "hand";
    for (const OrderedJson& solver : dataset["solvers"]) {
      const auto label = [&] {
        return dataset["model"].dump() + ", " + dataset["goal_weight_kg"].dump() + " kg: ";
      };
      EXPECT_GT(dataset["constraints"]["p50"], 0.0) << label();
      EXPECT_LE(solver["iterations"]["p50"], hand ? 100.0 : 20.0) << label();
      EXPECT_LE(solver["dual_updates"]["p95"], 3.0) << label();
      EXPECT_LE(solver["gdd_violation"]["p50"], 1e-7) << label();
      EXPECT_LE(solver["smooth_stationarity"]["p50"], 1e-6) << label();
      EXPECT_GE(solver["certified"], hand ? 0.5 : 0.9) << label();
      EXPECT_LE(solver["forward_iterations"]["p50"], 2.0) << label();
      EXPECT_GT(solver["solve_us"]["p50"], 0.0) << label();
      if (solver["name"] != "active-set") continue;
      EXPECT_LE(solver["iterations"]["p50"], (hand ? 2.0 : 1.0) * bound.median) << label();
      EXPECT_LE(solver["iterations"]["p95"], (hand ? 2.0 : 1.0) * bound.most) << label();
      EXPECT_LE(solver["gdd_violation"]["p95"], 1e-10) << label();
      EXPECT_GE(solver["certified"], bound.certified) << label();
    }
  }
}

// Guards against a solver that becomes worse. Solver 1's figures are what 20,000 records showed,
// with room for so few; solver 2's are what is asked of 20,000 by the goals' weight, with half as
// many iterations again at 95 % for so few. Beside solver 1 contacts are as soft as that has them;
// solver 2 alone has those that stick, as in a simulation.
TEST(GddBenchmark, StatisticsStayMet) {
  expectStatistics(benchmark({"--records", "2000", "--passes", "1", "--weight", "1", "--weight",
                              "100", "--weight", "1000"}));
}

TEST(GddBenchmark, StatisticsStayMetWhereContactsStick) {
  expectStatistics(
      benchmark({"--records", "2000", "--passes", "1", "--weight", "1", "--weight", "100",
                 "--weight", "1000", "--solvers", "active-set", "--record-with", "active-set"}));
}

// F rises from the minimum on both sides, and not as a parabola does: its slopes there are not 0.
TEST(GddBenchmark, DrawsAKinkOfTheRun) {
  const io::TempFolder folder;
  const std::string file = folder.path() / "kink.svg";
  const Outcome outcome = runProgram(
      "gdd_benchmark",
      {"--models", "humanoid", "--records", "300", "--kink", file, "--robots", dataFile("robots")});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(readFile(file).find("</svg>"), std::string::npos);
  const std::string words = "slopes up from the minimum: ";
  const std::size_t at = outcome.out.find(words);
  ASSERT_NE(at, std::string::npos) << outcome.out;
  double stiff = 0.0, free = 0.0;
  ASSERT_EQ(std::sscanf(outcome.out.c_str() + at + words.size(),
                        "%lf towards the stiff side, %lf towards the free side", &stiff, &free),
            2)
      << outcome.out;
  // Of a parabola they would be 0, but for rounding of 1e-16 F over the probe's 1e-3 N m.
  EXPECT_GT(stiff, 1.0);
  EXPECT_GT(free, 1.0);
}

TEST(GddBenchmark, InterruptGivesTheTablesOfWhatWasDone) {
  const io::TempFolder folder;
  const std::string file = folder.path() / "figures.json";
  const Outcome outcome = runProgram("gdd_benchmark",
                                     {"--records", "200", "--passes", "1000", "--models",
                                      "humanoid", "--robots", dataFile("robots"), "--json", file},
                                     2.0, file);
  EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
  EXPECT_NE(outcome.out.find("humanoid: "), std::string::npos);
  EXPECT_EQ(OrderedJson::parse(readFile(file))["datasets"].size(), 1u);
}

TEST(GddBenchmark, BadUsageIsToldAndNothingRuns) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--records", "0"},
                                                    {"--models", "arm"},
                                                    {"--weight", "-1"},
                                                    {"--solvers", "none"},
                                                    {"--robots", "nowhere"},
                                                    {"--json", "/nowhere/figures.json"},
                                                    {"--kink", "several_models.svg"}}) {
    const Outcome outcome = runProgram("gdd_benchmark", arguments);
    EXPECT_EQ(outcome.exitCode, 2) << arguments[0];
    EXPECT_EQ(outcome.out, "") << arguments[0];
    EXPECT_NE(outcome.err.find("gdd_benchmark: "), std::string::npos) << arguments[0];
  }
}

}  // namespace
}  // namespace softgauss::test
