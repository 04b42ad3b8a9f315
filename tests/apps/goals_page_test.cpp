// SPDX-License-Identifier: Apache-2.0
/// Every example of docs/reference/goals.md, run with the robot that the page names before it.

#include <algorithm>
#include <sstream>

#include "softgauss/io/detail/goal_kinds.hpp"
#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

struct Example {
  int line = 0;                        ///< of the page, where the block begins
  std::vector<std::string> arguments;  ///< MODEL and options, as the page gives them
  std::string yaml;

  bool isOf(const std::string& robot) const {
    return !arguments.empty() && arguments.front().ends_with("/" + robot + ".urdf");
  }
};

/// The words of the last code span of the text that begins with `data/`, the file with its folder.
std::vector<std::string> argumentsIn(const std::string& text) {
  const std::size_t begin = text.rfind("`data/");
  if (begin == std::string::npos) return {};
  std::istringstream span(text.substr(begin + 1, text.find('`', begin + 1) - begin - 1));
  std::vector<std::string> words;
  for (std::string word; span >> word;) words.push_back(word);
  words.front() = dataFile(words.front().substr(std::string("data/").size()));
  return words;
}

/// The YAML blocks of the page that hold goals, each with what the text since the last one names.
std::vector<Example> examplesOf(const std::string& page) {
  std::vector<Example> examples;
  std::istringstream lines(page);
  std::string before, line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (line != "```yaml") {
      before += line + "\n";
      continue;
    }
    Example example{number, argumentsIn(before), ""};
    for (; std::getline(lines, line) && line != "```"; ++number) example.yaml += line + "\n";
    ++number;
    before.clear();
    if (example.yaml.starts_with("goals:")) examples.push_back(example);
  }
  return examples;
}

std::vector<Example> examplesOfThePage() {
  return examplesOf(readFile(std::string(SOFTGAUSS_SOURCE_DIR) + "/docs/reference/goals.md"));
}

TEST(GoalsPage, ExamplesAreFoundWithTheirRobots) {
  const std::vector<Example> examples = examplesOf(
      "Text with `data/a.urdf`, and `data/b.urdf --duration 2`:\n\n```yaml\ngoals:\n  - x\n```\n"
      "```yaml\nother: 1\n```\n```yaml\ngoals: []\n```\n");
  ASSERT_EQ(examples.size(), 2u);
  EXPECT_EQ(examples[0].line, 3);
  EXPECT_EQ(examples[0].yaml, "goals:\n  - x\n");
  EXPECT_EQ(examples[0].arguments,
            (std::vector<std::string>{dataFile("b.urdf"), "--duration", "2"}));
  EXPECT_TRUE(examples[0].isOf("b"));
  EXPECT_TRUE(examples[1].arguments.empty());
  EXPECT_EQ(examples[1].line, 10);
}

TEST(GoalsPage, HasAnExampleOfEveryKind) {
  const std::vector<Example> examples = examplesOfThePage();
  for (const io::detail::GoalKind& kind : io::detail::goalKinds())
    EXPECT_TRUE(std::any_of(examples.begin(), examples.end(), [&](const Example& example) {
      return example.yaml.find("  - " + kind.name + ":") != std::string::npos;
    })) << kind.name;
}

// Each runs to its end and reaches the places that its goals name; the humanoid still stands then.
TEST(GoalsPage, ExamplesDoWhatThePageSays) {
  for (const Example& example : examplesOfThePage()) {
    SCOPED_TRACE("docs/reference/goals.md:" + std::to_string(example.line));
    ASSERT_FALSE(example.arguments.empty()) << "names no robot";
    const io::TempFolder folder;
    const std::string log = folder.path() / "log.csv";
    std::vector<std::string> arguments = example.arguments;
    arguments.insert(arguments.end(),
                     {"--goals", folder.write("goals.yaml", example.yaml), "--log", log});
    const Outcome outcome = simulate(arguments);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    // Of a goal that ends before the run, the summary tells where the link is later.
    if (example.yaml.find("end:") == std::string::npos) {
      EXPECT_EQ((outcome.out + outcome.err).find("not reached"), std::string::npos)
          << outcome.out << outcome.err;
    }
    if (!example.isOf("humanoid")) continue;
    const Csv table(readFile(log));
    EXPECT_GT(table.number(static_cast<int>(table.rows.size()) - 1, "q:pelvis.z"), 0.85)
        << "it stands with the pelvis at 0.92 m";
  }
}

TEST(GoalsPage, ACircleIsFollowedToAMillimetre) {
  int circles = 0;
  for (const Example& example : examplesOfThePage()) {
    if (example.yaml.find("circle:") == std::string::npos) continue;
    ++circles;
    const io::TempFolder folder;
    const std::string log = folder.path() / "log.csv";
    std::vector<std::string> arguments = example.arguments;
    arguments.insert(arguments.end(),
                     {"--goals", folder.write("goals.yaml", example.yaml), "--log", log});
    ASSERT_EQ(simulate(arguments).exitCode, 0);
    const Csv table(readFile(log));
    double worst = 0.0;
    for (int row = 0; row < static_cast<int>(table.rows.size()); ++row)
      if (table.number(row, "time_s") > 0.5)
        worst = std::max(worst, table.number(row, "error:reach hand [m]"));
    EXPECT_GT(worst, 0.0);
    EXPECT_LT(worst, 1e-3);
  }
  EXPECT_EQ(circles, 1);
}

}  // namespace
}  // namespace softgauss::test
