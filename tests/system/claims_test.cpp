// SPDX-License-Identifier: Apache-2.0
/// What README and docs say of other engines: who reads a figure finds the engine's version and the
/// command that repeats it, in the same section or at the head of the page.

#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "tests/system/source_rules.hpp"

namespace softgauss::test {
namespace {

const std::regex kEngine(
    R"(\b(MuJoCo|Drake|DART|Bullet|ODE|Simbody|Rapier|Jolt|RaiSim|PhysX|TSID)\b)");
const std::regex kColumn(
    R"(\| (MuJoCo|Drake|DART|Bullet|ODE|Simbody|Rapier|Jolt|RaiSim|PhysX|TSID)\b)");
/// A figure of a result. Counts, years and settings are none.
const std::regex kFigure(
    R"(\d ?(%|mm|µm|µs|times\b|mJ|J\b)|\d[.\d]*[eE]-?\d|10⁻|\bdiverges\b|\b(faster|slower) than\b)");
const std::regex kCommand(
    R"(`[^`]*(\./dev |build/\S+/(bin|tests)/|accuracy_cost|stability_report|compare_mujoco|step_benchmark)[^`]*`)");

/// Decisions tell what was known on their day, and theory what a law does: both give no comparison
/// to choose an engine by.
bool isAskedOf(const std::string& path) {
  return path == "README.md" ||
         (path.starts_with("docs/") && path.ends_with(".md") &&
          !path.starts_with("docs/decisions/") && !path.starts_with("docs/theory/"));
}

struct Section {
  std::size_t line = 0;
  std::vector<std::string> lines;
};

std::vector<Section> sectionsOf(const SourceFile& page) {
  std::vector<Section> sections(1);
  for (std::size_t i = 0; i < page.lines.size(); ++i) {
    if (page.lines[i].starts_with("## ")) sections.push_back({i, {}});
    sections.back().lines.push_back(page.lines[i]);
  }
  return sections;
}

std::set<std::string> namesIn(const std::string& line, const std::regex& pattern) {
  std::set<std::string> names;
  for (std::sregex_iterator m(line.begin(), line.end(), pattern), end; m != end; ++m)
    names.insert((*m)[1]);
  return names;
}

/// Engines of which a section gives figures: in a line of text, or in a table with a column of
/// theirs.
std::set<std::string> claimedIn(const Section& section) {
  std::set<std::string> claimed, ofTable;
  for (std::size_t i = 0; i < section.lines.size(); ++i) {
    const std::string& line = section.lines[i];
    std::set<std::string> named = namesIn(line, kEngine);
    const bool inTable = line.starts_with("|");
    if (!inTable) ofTable.clear();
    if (inTable && i + 1 < section.lines.size() && section.lines[i + 1].starts_with("|-"))
      ofTable = namesIn(line, kColumn);
    if (!std::regex_search(line, kFigure)) continue;
    claimed.merge(named);
    claimed.insert(ofTable.begin(), ofTable.end());
  }
  return claimed;
}

bool isMatchedIn(const Section& section, const std::regex& pattern) {
  for (const std::string& line : section.lines)
    if (std::regex_search(line, pattern)) return true;
  return false;
}

Complaints bareClaims(const SourceFile& page) {
  Complaints complaints;
  const std::vector<Section> sections = sectionsOf(page);
  for (const Section& section : sections)
    for (const std::string& engine : claimedIn(section)) {
      const std::regex version(engine + R"((\.js)?('s)? (\d+\.)+\d+)");
      const auto said = [&](const std::regex& pattern) {
        return isMatchedIn(section, pattern) || isMatchedIn(sections.front(), pattern);
      };
      if (!said(version))
        complaints.push_back(page.path + ":" + std::to_string(section.line + 1) + ": figures of " +
                             engine + " without its version");
      if (!said(kCommand))
        complaints.push_back(page.path + ":" + std::to_string(section.line + 1) + ": figures of " +
                             engine + " without a command");
    }
  return complaints;
}

TEST(Claims, OfOtherEnginesHaveVersionAndCommand) {
  std::size_t claims = 0;
  for (const SourceFile& file : tree()) {
    if (!isAskedOf(file.path)) continue;
    for (const Section& section : sectionsOf(file)) claims += claimedIn(section).size();
    for (const std::string& complaint : bareClaims(file)) ADD_FAILURE() << complaint;
  }
  EXPECT_GT(claims, 10u);
}

TEST(Claims, BareOnesAreFound) {
  const auto count = [](std::vector<std::string> lines) {
    return bareClaims({"docs/a.md", std::move(lines)}).size();
  };
  EXPECT_EQ(count({"# A", "We are 3 times as fast as Bullet."}), 2u);
  EXPECT_EQ(count({"# A", "`./dev rivals`: 3 times as fast as Bullet 3.24."}), 0u);
  EXPECT_EQ(count({"# A", "MuJoCo 3.14.0, `./dev rivals`", "## B", "| | ours | MuJoCo |",
                   "|---|---|---|", "| off | 1 mm | 2 mm |"}),
            0u);
  EXPECT_EQ(count({"# A", "| | ours | DART |", "|---|---|---|", "| off | 1 mm | 2 mm |"}), 2u);
  EXPECT_EQ(count({"# A", "## B", "Simbody 3.7, `./dev rivals`", "## C", "Simbody diverges."}), 2u);
  EXPECT_EQ(count({"# A", "The impedance is MuJoCo's, and ours gives 3 of them."}), 0u);
}

}  // namespace
}  // namespace softgauss::test
