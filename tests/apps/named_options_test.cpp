// SPDX-License-Identifier: Apache-2.0
/// Options have one list: what the program, scenes, Python and sweeps call them.

#include "softgauss/io/simulation/named_options.hpp"

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

#include "softgauss/io/simulation/parameter.hpp"
#include "softgauss/io/simulation/simulation.hpp"
#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

using Names = std::set<std::string>;

/// What stands in backquotes in a text, up to the first character that no name has.
Names quotedIn(const std::string& text) {
  Names names;
  const std::regex quoted("`([a-z][a-z_0-9]+)`");
  for (std::sregex_iterator it(text.begin(), text.end(), quoted), end; it != end; ++it)
    names.insert((*it)[1]);
  return names;
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  EXPECT_NE(begin, std::string::npos) << from;
  return begin == std::string::npos ? "" : text.substr(begin, text.find(to, begin) - begin);
}

std::string page(const std::string& name) {
  return readFile(std::string(SOFTGAUSS_SOURCE_DIR) + "/docs/reference/" + name);
}

Names allNames() {
  Names names;
  for (const NamedOption& option : NamedOption::all()) names.insert(option.name);
  return names;
}

/// Of the program's groups "Scene" and "Simulation".
Names ofTheProgram() {
  Names names;
  std::istringstream lines(simulate({"--help-all"}).out);
  std::string line, group;
  const std::regex heading("^([A-Z][a-z]+):?$"), option("^ +--([a-z0-9-]+)");
  for (std::smatch match; std::getline(lines, line);) {
    if (std::regex_search(line, match, heading)) group = match[1];
    if ((group != "Scene" && group != "Simulation") || !std::regex_search(line, match, option))
      continue;
    std::string name = match[1];
    std::replace(name.begin(), name.end(), '-', '_');
    names.insert(name == "package_path" ? "package_paths" : name);
  }
  return names;
}

TEST(NamedOptions, AreThoseOfTheProgram) {
  // What says how a program reads files, finds its settings or ends: no property of a simulation.
  const Names ofProgramsAlone = {"largest_file", "largest_mesh", "duration", "accuracy"};
  const Names program = ofTheProgram(), all = allNames();
  ASSERT_GT(program.size(), 20u);
  for (const std::string& name : program)
    EXPECT_TRUE(all.contains(name) != ofProgramsAlone.contains(name)) << name;
  for (const std::string& name : all) EXPECT_TRUE(program.contains(name)) << name;
}

TEST(NamedOptions, AreThoseThatThePagesOfPythonAndSweepsName) {
  const std::string python = between(page("python.md"), "Keywords are the options", ".\n");
  Names told = quotedIn(python);
  for (const char* own : {"without_goals", "without_servos", "visual_meshes"})
    EXPECT_TRUE(told.erase(own)) << own;
  EXPECT_EQ(told, allNames());
  EXPECT_EQ(quotedIn(between(page("batch.md"), "`base`, `base_height`", "\n- `vary`")), allNames());
}

TEST(NamedOptions, AreThoseOfASceneButForItsSolver) {
  const Names ofScenesAlone = {"tolerance", "max_iterations", "impedance_ratio"};
  const io::TempFolder folder;
  const std::string scene = folder.write("scene.yaml", "options: {nonsense: 1}\n");
  const std::string told = simulate({scene, "--passive"}).err;
  for (const NamedOption& option : NamedOption::all())
    EXPECT_EQ(std::regex_search(told, std::regex("\\b" + std::string(option.name) + "\\b")),
              option.ofScene)
        << option.name << ": " << told;
  for (const std::string& name : ofScenesAlone) EXPECT_NE(told.find(name), std::string::npos);
}

TEST(NamedOptions, TakeWhatTheySayAndNothingElse) {
  SimulationOptions options;
  const auto set = [&](const std::string& name, const OptionValue& value) {
    return NamedOption::find(name)->set(value, options);
  };
  EXPECT_TRUE(set("exact_diagonal", true));
  EXPECT_TRUE(options.exactDiagonal);
  EXPECT_FALSE(set("exact_diagonal", 1.0));
  EXPECT_TRUE(set("cone", std::string("elliptic")));
  EXPECT_FALSE(set("cone", std::string("round")));
  EXPECT_TRUE(set("sleep", std::string("all")));
  EXPECT_TRUE(options.sleep && options.sleep->enabled && options.sleep->controlled);
  EXPECT_FALSE(set("sleep", true));
  EXPECT_TRUE(set("effects", std::vector<std::string>{std::string(kEffectNames[0].name)}));
  EXPECT_FALSE(set("effects", std::vector<std::string>{"gravitation"}));
  EXPECT_TRUE(set("without", std::vector<std::string>{"supported_mass"}));
  EXPECT_FALSE(set("timestep", -0.001));
  EXPECT_TRUE(set("ground", std::string("none")));
  EXPECT_FALSE(options.groundIsDefault);
  EXPECT_FALSE(options.ground.has_value());
  EXPECT_EQ(NamedOption::find("levelslip"), nullptr);
}

// What the page says of `*`.
TEST(Parameters, TakeAStarWhereOneValueCanBeMeantForAll) {
  const std::string text = page("batch.md");
  const std::string list = between(text, "take `*` for all", "## Results");
  std::istringstream lines(list);
  std::set<std::string> kinds;
  std::string line;
  const auto scene = loadScene(dataFile("robots/arm.urdf"));
  const std::regex parameter("`([a-z_]+):[A-Zxa-z]");
  for (int number = -1; std::getline(lines, line);) {
    if (!line.starts_with("- ")) continue;
    ++number;
    for (std::sregex_iterator it(line.begin(), line.end(), parameter), end; it != end; ++it) {
      const std::string kind = (*it)[1];
      if (!kinds.insert(kind).second) continue;
      const auto make = [&] { Parameter(scene->model, kind + ":*"); };
      if (number < 2)
        EXPECT_NO_THROW(make()) << kind;
      else
        EXPECT_THROW(make(), NameError) << kind;
    }
  }
  std::vector<std::string> all = parameterKinds();
  std::erase(all, "timestep");
  EXPECT_EQ(kinds, std::set<std::string>(all.begin(), all.end()));
}

}  // namespace
}  // namespace softgauss::test
