// SPDX-License-Identifier: Apache-2.0
/// accuracy_cost on a problem with a closed form: errors are those of the methods' orders, a run
/// goes on where another ended, and the page holds what the table does.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/apps/process.hpp"
#include "tests/apps/short_study.hpp"

namespace softgauss::test {
namespace {

/// --drift or --divergence in the place of a study.
std::vector<std::string> instead(const std::string& problem, const std::string& out,
                                 const std::string& what) {
  return {"--scene", problem, "--out", out, "--robots", dataFile("robots"), what};
}

// Columns of the table.
constexpr std::size_t kError = 10, kTime = 12, kReferenceError = 17, kOneStep = 18;

/// A column by (label, steps a period).
std::map<std::pair<std::string, int>, double> columnOf(const std::string& file,
                                                       std::size_t column) {
  std::map<std::pair<std::string, int>, double> errors;
  std::istringstream in(readFile(file));
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::istringstream cell(line);
    for (std::string text; std::getline(cell, text, ',');) cells.push_back(text);
    errors[{cells.at(3), static_cast<int>(std::lround(0.032 / std::stod(cells.at(9))))}] =
        std::stod(cells.at(column));
  }
  return errors;
}

/// What a page holds.
nlohmann::json problemsOf(const std::string& page) {
  const std::string begin = "const problems = ";
  const std::size_t from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find(";\n", from) - from));
}

/// Of the first problem in a folder.
nlohmann::json curvesOf(const std::string& folder) {
  return problemsOf(readFile(folder + "/accuracy_cost.html")).at(0)["curves"];
}

/// "#0072b2" as gnuplot writes it: "rgb(  0, 114, 178)".
std::string asRgb(const std::string& colour) {
  unsigned r = 0, g = 0, b = 0;
  std::sscanf(colour.c_str(), "#%2x%2x%2x", &r, &g, &b);
  char text[32];
  std::snprintf(text, sizeof text, "rgb(%3u, %3u, %3u)", r, g, b);
  return text;
}

/// The table with elliptic cones as fast as nothing.
std::string ellipticWithoutTime(const std::string& table) {
  std::istringstream in(table);
  std::string line, result;
  for (bool first = true; std::getline(in, line); first = false) {
    std::vector<std::string> cells;
    std::istringstream cell(line);
    for (std::string text; std::getline(cell, text, ',');) cells.push_back(text);
    if (!first && cells.at(4) == "elliptic") cells.at(12) = "1e-9";
    for (std::size_t i = 0; i < cells.size(); ++i) result += (i == 0 ? "" : ",") + cells[i];
    result += '\n';
  }
  return result;
}

/// accuracy_solver.md of the ball: errors at 2 ms, and times over the first.
void expectSolverTable(const std::string& out) {
  auto errors = columnOf(out + "/accuracy_cost.csv", kError);
  auto times = columnOf(out + "/accuracy_cost.csv", kTime);
  char first[64], loose[64];
  const std::pair<std::string, int> plain{"leapfrog", 16};
  std::snprintf(first, sizeof first, "| bouncing_ball | %.1e m, %.2g s per s |", errors.at(plain),
                times.at(plain));
  const std::pair<std::string, int> elliptic{"leapfrog with elliptic cones", 16};
  std::snprintf(loose, sizeof loose, " %.1e m, %.2f |\n", errors.at(elliptic),
                times.at(elliptic) / times.at(plain));
  const std::string table = readFile(out + "/accuracy_solver.md");
  EXPECT_NE(table.find(first), std::string::npos) << first << "\n" << table;
  EXPECT_NE(table.find(loose), std::string::npos) << loose << "\n" << table;
  // Other methods have tables of their own; the solver's tolerance changes no digit that is shown.
  for (const char* method : {"implicit midpoint", "Dormand-Prince to 1e-08", "MuJoCo Euler"}) {
    const std::string name = method, begin = "| at 2 ms | " + name + " | ";
    if (!errors.contains({name, 16})) continue;  // MuJoCo was not found
    const std::size_t head = table.find(begin + name + " with solver to ");
    ASSERT_NE(head, std::string::npos) << method << table;
    std::snprintf(first, sizeof first, "| bouncing_ball | %.1e m,", errors.at({name, 16}));
    EXPECT_EQ(table.find(first, head), table.find("| bouncing_ball |", head)) << method << table;
  }
  const std::string orders = readFile(out + "/accuracy_orders.md");
  const std::size_t oneStep = orders.find("| order of one step |");
  ASSERT_NE(oneStep, std::string::npos);
  double leapfrog = 0.0, order = 0.0;
  std::sscanf(orders.c_str() + orders.find("| bouncing_ball |", oneStep),
              "| bouncing_ball | %lf | %lf", &leapfrog, &order);
  EXPECT_NEAR(leapfrog, 3.0, 0.3) << orders;
  EXPECT_NEAR(order, 2.0, 0.2) << orders;
}

// What the references do not tell has hollow markers: gnuplot's sixth, which it calls gpPt5.
TEST(AccuracyCost, MarkersThatAreNotToldAreHollow) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study";
  ASSERT_EQ(runProgram("accuracy_cost", study("bouncing_ball", out)).exitCode, 0);
  const auto errors = columnOf(out + "/accuracy_cost.csv", kError);
  const auto references = columnOf(out + "/accuracy_cost.csv", kReferenceError);
  std::set<std::string> drawn;  // solvers of some methods are in a table alone
  for (const nlohmann::json& curve : curvesOf(out)) drawn.insert(curve["label"]);
  int untold = 0;
  for (const auto& [setting, error] : errors)
    untold += drawn.contains(setting.first) && std::isfinite(error) &&
              10.0 * references.at(setting) > error;
  EXPECT_GT(untold, 0);
  EXPECT_LT(untold, static_cast<int>(errors.size()));
  const std::string svg = readFile(out + "/bouncing_ball.svg");
  if (svg.empty()) GTEST_SKIP() << "gnuplot was not found";
  int hollow = 0;
  const std::string use = "xlink:href='#gpPt5' transform";
  for (std::size_t at = svg.find(use); at != std::string::npos; at = svg.find(use, at + 1))
    ++hollow;
  EXPECT_EQ(hollow, untold);
  EXPECT_NE(svg.find("below (hollow): not resolved"), std::string::npos);
}

TEST(AccuracyCost, ErrorsFallWithTheOrder) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study";
  const std::vector<std::string> arguments = study("pendulum", out);
  const Outcome outcome = runProgram("accuracy_cost", arguments);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  auto errors = columnOf(out + "/accuracy_cost.csv", kError);
  const auto order = [&](const std::string& label) {
    return std::log2(errors.at({label, 4}) / errors.at({label, 16})) / 2.0;
  };
  EXPECT_NEAR(order("leapfrog"), 5.0, 0.3);  // what swings freely is followed to a tolerance
  EXPECT_NEAR(order("semi-implicit Euler"), 1.0, 0.1);
  EXPECT_NEAR(order("implicit in velocity"), 1.0, 0.1);
  EXPECT_NEAR(order("implicit midpoint"), 2.0, 0.1);
  EXPECT_NEAR(order("Runge-Kutta 4"), 4.0, 0.1);
  EXPECT_GT(errors.at({"leapfrog with step doubling to 1e-04", 1}),
            10.0 * errors.at({"leapfrog with step doubling to 1e-06", 1}));
  EXPECT_LT(errors.at({"Dormand-Prince to 1e-11", 1}), 1e-9);

  // All is there: the second run measures nothing, and leaves the table as it is.
  const std::string table = readFile(out + "/accuracy_cost.csv");
  ASSERT_EQ(runProgram("accuracy_cost", arguments).exitCode, 0);
  EXPECT_EQ(readFile(out + "/accuracy_cost.csv"), table);
  // A line that an interrupt has cut is measured anew, and only that.
  std::ofstream(out + "/accuracy_cost.csv") << table.substr(0, table.size() - 30);
  ASSERT_EQ(runProgram("accuracy_cost", arguments).exitCode, 0);
  EXPECT_EQ(columnOf(out + "/accuracy_cost.csv", kError), errors);

  // The table of orders has them too: one row, a cell for each method of fixed steps.
  const std::string orders = readFile(out + "/accuracy_orders.md");
  EXPECT_NE(orders.find(" | 1.0 | 1.0 | 1.0 | 2.0 | 4.0 |"), std::string::npos) << orders;
  EXPECT_EQ(readFile(out + "/accuracy_solver.md"), "") << "a pendulum touches nothing";

  const std::string page = readFile(out + "/accuracy_cost.html");
  const nlohmann::json problems = problemsOf(page);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0]["name"], "pendulum");
  std::size_t points = 0;
  for (const nlohmann::json& curve : problems[0]["curves"]) points += curve["points"].size();
  EXPECT_EQ(points, errors.size());
  EXPECT_EQ(page.find("http"), page.find("http://www.w3.org/2000/svg")) << "needs no network";
}

// The default follows a tree that swings freely, to a tolerance that falls with the step; the order
// of the others is told from where steps are short.
TEST(AccuracyCost, OrdersAreThoseBelowTheTurn) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study";
  ASSERT_EQ(runProgram("accuracy_cost", study("chain_5", out)).exitCode, 0);
  const auto errors = columnOf(out + "/accuracy_cost.csv", kError);
  for (const int steps : {1, 4, 16})
    EXPECT_LT(errors.at({"leapfrog", steps}), 1e-7 / steps) << steps;
  const std::string orders = readFile(out + "/accuracy_orders.md");
  EXPECT_NE(orders.find("| chain_5 | "), std::string::npos) << orders;
}

TEST(AccuracyCost, DriftTellsWhoKeepsTheEnergy) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study";
  const Outcome outcome = runProgram("accuracy_cost", instead("free_body", out, "--drift"));
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  std::istringstream in(readFile(out + "/drift.csv"));
  double midpoint = 1.0, euler = 0.0;
  for (std::string line; std::getline(in, line);) {
    std::sscanf(line.c_str(), "free_body,softgauss,implicit midpoint,%lf", &midpoint);
    std::sscanf(line.c_str(), "free_body,softgauss,semi-implicit Euler as MuJoCo's,%lf", &euler);
  }
  EXPECT_LT(midpoint, 1e-10);
  EXPECT_GT(euler, 1e-4);
}

// In one step a method of order p errs by O(h^(p+1)); the ball falls freely in most windows, and in
// some it lies on the ground.
TEST(AccuracyCost, OneStepErrsByOneOrderMore) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study";
  const Outcome outcome = runProgram("accuracy_cost", study("bouncing_ball", out));
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const auto errors = columnOf(out + "/accuracy_cost.csv", kOneStep);
  for (const char* label : {"semi-implicit Euler", "implicit in velocity"})
    EXPECT_NEAR(std::log2(errors.at({label, 4}) / errors.at({label, 32})) / 3.0, 2.0, 0.2) << label;
  EXPECT_LT(errors.at({"Runge-Kutta 4", 4}), 1e-2 * errors.at({"semi-implicit Euler", 4}));
  EXPECT_GT(errors.at({"Runge-Kutta 4", 4}), 0.0);

  expectSolverTable(out);

  // A line that was cut within its last number still has all its columns: it is measured anew too.
  const std::string file = out + "/accuracy_cost.csv", table = readFile(file);
  std::ofstream(file) << table.substr(0, table.size() - 3);
  ASSERT_EQ(runProgram("accuracy_cost", study("bouncing_ball", out)).exitCode, 0);
  EXPECT_EQ(columnOf(file, kOneStep), errors);

  // Elliptic cones are another model: however fast, they are no answer to a question about this
  // one.
  std::ofstream(file) << ellipticWithoutTime(readFile(file));
  ASSERT_EQ(runProgram("accuracy_cost", study("bouncing_ball", out)).exitCode, 0);
  const std::string best = readFile(out + "/accuracy_table.md");
  EXPECT_NE(best.find("| bouncing_ball | 0.01 m |"), std::string::npos);
  EXPECT_EQ(best.find("elliptic"), std::string::npos) << best;
  for (const nlohmann::json& curve : curvesOf(out))
    EXPECT_EQ(curve["sameModel"], curve["label"] != "leapfrog with elliptic cones");
}

// A colour means a method, in every picture, and MuJoCo's has that of its counterpart.
TEST(AccuracyCost, ColoursAreThoseOfMethods) {
  const io::TempFolder folder;
  std::map<std::string, std::string> colours;
  for (const char* problem : {"pendulum", "bouncing_ball"}) {
    const std::string out = folder.path() / problem;
    ASSERT_EQ(runProgram("accuracy_cost", study(problem, out, {"--most-seconds", "10"})).exitCode,
              0);
    for (const nlohmann::json& curve : curvesOf(out)) {
      const std::string colour = curve["colour"];
      EXPECT_EQ(colours.try_emplace(curve["label"], colour).first->second, colour);
      const std::string svg = readFile(out + "/" + problem + ".svg");
      if (svg.empty()) continue;  // no gnuplot
      EXPECT_NE(svg.find(asRgb(colour)), std::string::npos) << colour;
    }
  }
  std::map<std::string, std::string> ours;
  for (const auto& [label, colour] : colours)
    if (!label.starts_with("MuJoCo")) {
      EXPECT_TRUE(ours.try_emplace(colour, label).second) << label << " and " << ours[colour];
    }
  for (const auto& [theirs, label] : {std::pair{"MuJoCo Euler", "semi-implicit Euler as MuJoCo's"},
                                      {"MuJoCo implicit", "implicit in velocity"},
                                      {"MuJoCo RK4", "Runge-Kutta 4"}})
    if (colours.contains(theirs)) {
      EXPECT_EQ(colours[theirs], colours.at(label));
    }
}

// A push of a damped spring grows by the closed form: x ~ e^(−s t) sin ω t.
TEST(AccuracyCost, DivergenceIsThatOfTheMotion) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study";
  const Outcome outcome =
      runProgram("accuracy_cost", instead("spring_mass_damper", out, "--divergence"));
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  constexpr double kMass = 2.0, kStiffness = 800.0, kDamping = 8.0, kPeriod = 0.032;
  const double s = 0.5 * kDamping / kMass, w = std::sqrt(kStiffness / kMass - s * s);
  const auto x = [&](int k) { return std::exp(-s * k * kPeriod) * std::sin(w * k * kPeriod); };
  double most = 0.0, whole = 0.0;
  for (int k = 1; k <= 62; ++k) most = std::max(most, std::abs(x(k) / x(1)));
  std::istringstream in(readFile(out + "/divergence.csv"));
  for (std::string line; std::getline(in, line);)
    std::sscanf(line.c_str(), "spring_mass_damper,%lf", &whole);
  EXPECT_NEAR(whole, most, 0.01 * most);  // steps of 0.25 ms
}

TEST(AccuracyCost, GivesUpWhatIsTooDear) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study";
  const Outcome outcome =
      runProgram("accuracy_cost", study("pendulum", out, {"--most-seconds", "0"}));
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("given up"), std::string::npos);
  for (const auto& [setting, error] : columnOf(out + "/accuracy_cost.csv", kError))
    EXPECT_TRUE(std::isnan(error)) << setting.first;
  const std::string table = readFile(out + "/accuracy_table.md");
  EXPECT_NE(table.find("Given up, for it takes too long: pendulum, Runge-Kutta 4, 32 ms."),
            std::string::npos);
  EXPECT_NE(table.find("| pendulum | 0.01 m | not reached |"), std::string::npos) << table;
  // Given as much time again it is given up as before; given more, it is measured.
  const std::string file = readFile(out + "/accuracy_cost.csv");
  runProgram("accuracy_cost", study("pendulum", out, {"--most-seconds", "0"}));
  EXPECT_EQ(readFile(out + "/accuracy_cost.csv"), file);
  runProgram("accuracy_cost", study("pendulum", out));
  for (const auto& [setting, error] : columnOf(out + "/accuracy_cost.csv", kError))
    EXPECT_FALSE(std::isnan(error)) << setting.first;
  // What was measured in its place stays in its place.
  runProgram("accuracy_cost", study("pendulum", out, {"--most-seconds", "0"}));
  for (const auto& [setting, error] : columnOf(out + "/accuracy_cost.csv", kError))
    EXPECT_FALSE(std::isnan(error)) << setting.first;
}

// The reference of the chain takes seconds: the interrupt falls into it.
TEST(AccuracyCost, EndsInOrderWhenInterrupted) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study", table = out + "/accuracy_cost.csv";
  const Outcome outcome = runProgram("accuracy_cost", study("chain_20", out), 0.2, table);
  EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
  EXPECT_EQ(outcome.out.find("not finite"), std::string::npos) << outcome.out;
  EXPECT_TRUE(columnOf(table, kError).empty());
}

// Options that would change nothing are bad usage.
TEST(AccuracyCost, OptionsThatChangeNothingAreRefused) {
  for (const auto& arguments :
       std::vector<std::vector<std::string>>{{"--trial-seconds", "1"},
                                             {"--drift", "--seconds", "10"},
                                             {"--drift", "--repeats", "1"},
                                             {"--divergence", "--most-steps", "32"},
                                             {"--divergence", "--drift"},
                                             {"--verify-accuracy", "--drift"},
                                             {"--nonsense"}}) {
    const Outcome outcome = runProgram("accuracy_cost", arguments);
    EXPECT_EQ(outcome.exitCode, 2) << arguments.back();
    EXPECT_NE(outcome.err.find(arguments.front()), std::string::npos) << outcome.err;
  }
}

TEST(AccuracyCost, UnknownProblemsAreRefused) {
  const Outcome outcome = runProgram("accuracy_cost", {"--scene", "pendulums"});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.err.find("no problem 'pendulums'"), std::string::npos);
}

}  // namespace
}  // namespace softgauss::test
