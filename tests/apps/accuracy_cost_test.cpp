// SPDX-License-Identifier: Apache-2.0
/// accuracy_cost on a problem with a closed form: errors are those of the methods' orders, a run
/// goes on where another ended, and the page holds what the table does.

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

/// error by (label, steps a period).
std::map<std::pair<std::string, int>, double> errorsOf(const std::string& file) {
  std::map<std::pair<std::string, int>, double> errors;
  std::istringstream in(readFile(file));
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<std::string> cells;
    std::istringstream cell(line);
    for (std::string text; std::getline(cell, text, ',');) cells.push_back(text);
    errors[{cells.at(3), static_cast<int>(std::lround(0.032 / std::stod(cells.at(8))))}] =
        std::stod(cells.at(9));
  }
  return errors;
}

TEST(AccuracyCost, ErrorsFallWithTheOrder) {
  const io::TempFolder folder;
  const std::string out = folder.path() / "study";
  const std::vector<std::string> arguments = {
      "--scene", "pendulum",  "--out", out,        "--min-time",
      "0",       "--repeats", "1",     "--robots", dataFile("robots")};
  const Outcome outcome = runProgram("accuracy_cost", arguments);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  auto errors = errorsOf(out + "/accuracy_cost.csv");
  const auto order = [&](const std::string& label) {
    return std::log2(errors.at({label, 4}) / errors.at({label, 16})) / 2.0;
  };
  EXPECT_NEAR(order("semi-implicit Euler"), 1.0, 0.1);
  EXPECT_NEAR(order("Runge-Kutta 4"), 4.0, 0.1);
  EXPECT_LT(errors.at({"Dormand-Prince to 1e-11", 1}), 1e-9);

  // All is there: the second run measures nothing, and leaves the table as it is.
  const std::string table = readFile(out + "/accuracy_cost.csv");
  ASSERT_EQ(runProgram("accuracy_cost", arguments).exitCode, 0);
  EXPECT_EQ(readFile(out + "/accuracy_cost.csv"), table);
  // A line that an interrupt has cut is measured anew, and only that.
  std::ofstream(out + "/accuracy_cost.csv") << table.substr(0, table.size() - 30);
  ASSERT_EQ(runProgram("accuracy_cost", arguments).exitCode, 0);
  EXPECT_EQ(errorsOf(out + "/accuracy_cost.csv"), errors);

  const std::string page = readFile(out + "/accuracy_cost.html");
  const std::string begin = "const problems = ";
  const std::size_t from = page.find(begin) + begin.size();
  const nlohmann::json problems =
      nlohmann::json::parse(page.substr(from, page.find(";\n", from) - from));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0]["name"], "pendulum");
  std::size_t points = 0;
  for (const nlohmann::json& curve : problems[0]["curves"]) points += curve["points"].size();
  EXPECT_EQ(points, errors.size());
  EXPECT_EQ(page.find("http"), page.find("http://www.w3.org/2000/svg")) << "needs no network";
}

TEST(AccuracyCost, UnknownProblemsAreRefused) {
  const Outcome outcome = runProgram("accuracy_cost", {"--scene", "pendulums"});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_NE(outcome.err.find("no problem 'pendulums'"), std::string::npos);
}

}  // namespace
}  // namespace softgauss::test
