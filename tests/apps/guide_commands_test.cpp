// SPDX-License-Identifier: Apache-2.0
/// Every command of simulate_gdd in docs/guide and docs/reference runs as the pages give it.

#include <algorithm>
#include <filesystem>
#include <regex>
#include <sstream>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

struct PageCommand {
  std::string page;
  int line = 0;
  std::string text;  ///< from the program's name on

  std::string where() const { return page + ":" + std::to_string(line) + ": " + text; }
};

/// Lines that begin with the program of the release build.
std::vector<PageCommand> commandsOf(const std::string& page, const std::string& text) {
  const std::string folder = "build/release/bin/", program = "simulate_gdd ";
  std::vector<PageCommand> commands;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number)
    if (line.starts_with(folder + program))
      commands.push_back({page, number, line.substr(folder.size())});
  return commands;
}

std::vector<PageCommand> commandsOfThePages() {
  std::vector<PageCommand> all;
  std::vector<std::filesystem::path> pages;
  for (const char* folder : {"guide", "reference"})
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(SOFTGAUSS_SOURCE_DIR) + "/docs/" + folder))
      pages.push_back(entry.path());
  std::sort(pages.begin(), pages.end());
  for (const std::filesystem::path& page : pages)
    for (const PageCommand& command : commandsOf(page.filename().string(), readFile(page)))
      all.push_back(command);
  return all;
}

/// In a folder of its own: data from the sources, outputs into that folder.
std::string asTyped(const PageCommand& command, const std::string& duration) {
  std::string text = command.text;
  if (!duration.empty())
    text = std::regex_replace(text, std::regex(" --duration \\S+"), "") + " --duration " + duration;
  text = std::regex_replace(text, std::regex(" data/"), " " + dataFile(""));
  return std::regex_replace(text, std::regex(" build/"), " ");
}

/// Every robot that could fall stands at the end.
void expectStood(const std::string& out) {
  const std::regex verdict("(^|\n)(stood|fell|falling|in the air): +base ");
  for (std::sregex_iterator it(out.begin(), out.end(), verdict), end; it != end; ++it)
    EXPECT_EQ((*it)[2], "stood") << out;
}

void expectRuns(const std::string& duration) {
  const std::vector<PageCommand> commands = commandsOfThePages();
  EXPECT_GT(commands.size(), 20u);
  const io::TempFolder folder;
  for (const PageCommand& command : commands) {
    SCOPED_TRACE(command.where());
    const Outcome outcome = runShell(folder.path(), asTyped(command, duration));
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    if (command.page == "recipes.md" && duration.empty()) expectStood(outcome.out);
  }
}

TEST(GuideCommands, AreFound) {
  const std::vector<PageCommand> commands = commandsOf(
      "a.md", "text\nbuild/release/bin/simulate_gdd data/a.urdf --log build/a.csv --duration 3\n");
  ASSERT_EQ(commands.size(), 1u);
  EXPECT_EQ(commands[0].line, 2);
  EXPECT_EQ(asTyped(commands[0], "0.1"),
            "simulate_gdd " + dataFile("a.urdf") + " --log a.csv --duration 0.1");
}

TEST(GuideCommands, Begin) { expectRuns("0.02"); }

// The recipes end on their feet.
TEST(GuideCommandsLong, RunToTheirEnd) { expectRuns(""); }

}  // namespace
}  // namespace softgauss::test
