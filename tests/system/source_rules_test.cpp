// SPDX-License-Identifier: Apache-2.0
#include "tests/system/source_rules.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace softgauss::test {
namespace {

template <class Rule>
void expectHolds(const Rule& rule) {
  for (const SourceFile& file : tree())
    for (const std::string& complaint : rule(file)) ADD_FAILURE() << complaint;
}

// Complaints about a file of one line.
template <class Rule>
std::size_t count(const Rule& rule, const std::string& path, const std::string& line) {
  return rule(SourceFile{path, {line}}).size();
}

// ---- The tree ----

TEST(Tree, IsRead) {
  std::set<std::string> paths;
  for (const SourceFile& file : tree()) paths.insert(file.path);
  for (const char* path : {"CMakeLists.txt", "dev", ".ci/run", "engine/core/types.hpp"})
    EXPECT_EQ(paths.count(path), 1u) << path;
}

TEST(Tree, IncludesFollowTheLayers) { expectHolds(checkIncludes); }
TEST(Tree, FclIsFenced) { expectHolds(checkFcl); }
TEST(Tree, FilesAreShort) { expectHolds(checkLength); }
TEST(Tree, FilesNameTheirLicence) { expectHolds(checkLicence); }
TEST(Tree, NamesNoMachineAndNoWorkLeftOver) { expectHolds(checkWords); }

TEST(Tree, CitedEquationsExist) {
  std::set<std::string> theory;
  for (const SourceFile& file : tree())
    if (isChapterOfTheory(file)) theory.merge(equationsOfChapter(file));
  EXPECT_GT(theory.size(), 100u);
  // The rules' own tests cite equations that exist nowhere.
  expectHolds([&](const SourceFile& file) {
    return file.path.find("/source_rules") == std::string::npos ? checkEquations(file, theory)
                                                                : Complaints();
  });
}

TEST(Tree, RootHoldsOnlyWhatBelongsThere) {
  std::set<std::string> entries;
  for (const auto& entry : std::filesystem::directory_iterator(SOFTGAUSS_SOURCE_DIR))
    entries.insert(entry.path().filename().string());
  for (const std::string& complaint : checkRoot(entries)) ADD_FAILURE() << complaint;
}

// ---- The rules can fail ----

TEST(SourceRules, LayersIncludeDownwards) {
  const auto ours = [](const std::string& path, const std::string& header) {
    return count(checkIncludes, path, "#include \"" + header + "\"");
  };
  EXPECT_EQ(ours("engine/step/step.cpp", "softgauss/engine/solver/newton.hpp"), 0u);
  EXPECT_EQ(ours("engine/model/detail/a.cpp", "softgauss/engine/model/model.hpp"), 0u);
  EXPECT_EQ(ours("engine/engine.hpp", "softgauss/engine/step/step.hpp"), 0u);
  EXPECT_EQ(ours("io/goals.cpp", "softgauss/gdd/goal.hpp"), 0u);
  EXPECT_EQ(ours("apps/simulate_gdd.cpp", "softgauss/io/urdf.hpp"), 0u);

  EXPECT_EQ(ours("engine/core/types.hpp", "softgauss/engine/model/model.hpp"), 1u);
  EXPECT_EQ(ours("engine/solver/newton.cpp", "softgauss/engine/model/model.hpp"), 1u);
  EXPECT_EQ(ours("engine/forces/spring.cpp", "softgauss/engine/constraints/rows.hpp"), 1u);
  EXPECT_EQ(ours("engine/model/model.hpp", "softgauss/engine/engine.hpp"), 1u);
  EXPECT_EQ(ours("engine/step/step.cpp", "softgauss/gdd/goal.hpp"), 1u);
  EXPECT_EQ(ours("collision/manifold.cpp", "softgauss/io/urdf.hpp"), 1u);
  EXPECT_EQ(ours("io/urdf.cpp", "softgauss/collision/manifold.hpp"), 1u);
  EXPECT_EQ(ours("io/urdf.cpp", "softgauss/io/simulation/scene.hpp"), 1u);
  EXPECT_EQ(ours("io/simulation/scene.cpp", "softgauss/collision/manifold.hpp"), 0u);
  EXPECT_EQ(ours("io/simulation/scene.cpp", "softgauss/io/urdf.hpp"), 0u);
  EXPECT_EQ(ours("io/simulation/scene.cpp", "apps/shared/ground.hpp"), 1u);
  EXPECT_EQ(ours("io/urdf.cpp", "urdf.hpp"), 1u);
  EXPECT_EQ(ours("io/urdf.cpp", std::string("io/") + "scene.hpp"), 1u);  // without softgauss/
  EXPECT_EQ(ours("tests/io/urdf_test.cpp", "sample_urdf.hpp"), 0u);
}

TEST(SourceRules, LibrariesStayInTheirSources) {
  const auto theirs = [](const std::string& path, const std::string& header) {
    return count(checkIncludes, path, "#include <" + header + ">");
  };
  EXPECT_EQ(theirs("engine/core/types.hpp", "Eigen/Core"), 0u);
  EXPECT_EQ(theirs("collision/detail/fcl_tree.cpp", "fcl/fcl.h"), 0u);
  EXPECT_EQ(theirs("io/urdf.cpp", "tinyxml2.h"), 0u);
  EXPECT_EQ(theirs("apps/simulate_gdd.cpp", "CLI/CLI.hpp"), 0u);

  EXPECT_EQ(theirs("collision/detail/fcl_tree.hpp", "fcl/fcl.h"), 1u);
  EXPECT_EQ(theirs("engine/model/shape.cpp", "fcl/fcl.h"), 1u);
  EXPECT_EQ(theirs("io/mesh.cpp", "ccd/ccd.h"), 1u);
  EXPECT_EQ(theirs("io/urdf.hpp", "urdf_model/model.h"), 1u);
  EXPECT_EQ(theirs("io/log.cpp", "iostream"), 1u);
}

TEST(SourceRules, FclOutsideItsFenceIsFound) {
  const std::string include = "#include <fcl/fcl.h>";
  EXPECT_EQ(count(checkFcl, "collision/detail/fcl_tree.cpp", include), 0u);
  EXPECT_EQ(count(checkFcl, "tests/collision/oracle_test.cpp", include), 0u);
  EXPECT_EQ(count(checkFcl, "collision/detail/fcl_tree.hpp", include), 1u);
  EXPECT_EQ(count(checkFcl, "collision/manifold.cpp", include), 1u);
  EXPECT_EQ(count(checkFcl, "apps/a/main.cpp", "#include <ccd/ccd.h>"), 1u);
  const SourceFile asks{"tests/a.cpp", {include, "request.enable_signed_distance = true;"}};
  EXPECT_EQ(checkFcl(asks).size(), 1u);
  EXPECT_EQ(count(checkFcl, "collision/box_pairs.hpp", "/// Signed distance [m]."), 0u);
}

TEST(SourceRules, FilesThatGoOnAndOnAreFound) {
  EXPECT_TRUE(checkLength({"engine/a.cpp", std::vector<std::string>(400)}).empty());
  EXPECT_FALSE(checkLength({"engine/a.cpp", std::vector<std::string>(401)}).empty());
  EXPECT_FALSE(checkLength({"tests/a/a.mjs", std::vector<std::string>(401)}).empty());
  EXPECT_FALSE(checkLength({"tests/a/a.py", std::vector<std::string>(401)}).empty());
}

TEST(SourceRules, MissingLicencesAreFound) {
  EXPECT_EQ(count(checkLicence, "gdd/goal.hpp", "// SPDX-License-Identifier: Apache-2.0"), 0u);
  EXPECT_EQ(count(checkLicence, "gdd/goal.hpp", "#pragma once"), 1u);
  EXPECT_EQ(count(checkLicence, "gdd/CMakeLists.txt", "project(x)"), 1u);
  EXPECT_EQ(count(checkLicence, "tests/a/a.mjs", "import x;"), 1u);
  EXPECT_EQ(count(checkLicence, "io/a/a.js", "import x;"), 1u);
  EXPECT_EQ(count(checkLicence, "tests/a/a.py", "# SPDX-License-Identifier: Apache-2.0"), 0u);
  EXPECT_EQ(count(checkLicence, "tests/a/a.py", "import x"), 1u);
  EXPECT_FALSE(checkLicence({"gdd/goal.hpp", {}}).empty());
}

TEST(SourceRules, MachinePathsAndLeftOversAreFound) {
  // In pieces, so that this file passes its own test.
  const std::string home =
                        "/ho"
                        "me/anna/robot.urdf",
                    left =
                        "TO"
                        "DO",
                    fix =
                        "FIX"
                        "ME";
  EXPECT_EQ(count(checkWords, "docs/a.md", "see " + home), 1u);
  EXPECT_EQ(count(checkWords, "dev", home), 1u);
  EXPECT_EQ(count(checkWords, "gdd/goal.hpp", "// " + left + ": later"), 1u);
  EXPECT_EQ(count(checkWords, "gdd/goal.hpp", "// " + fix), 1u);
  EXPECT_EQ(count(checkWords, "docs/a.md", "https://example.org" + home), 0u);
  EXPECT_EQ(count(checkWords, "docs/a.md", "the todo list"), 0u);
}

TEST(SourceRules, UnknownEquationsAreFound) {
  const SourceFile chapter{"docs/theory/03-softness.md",
                           {"x = y (3.1), (3.12), as (4.2), 0.5 (0.5)"}};
  EXPECT_TRUE(isChapterOfTheory(chapter));
  EXPECT_FALSE(isChapterOfTheory({"docs/theory/notation.md", {}}));
  const std::set<std::string> theory = equationsOfChapter(chapter);
  EXPECT_EQ(theory, (std::set<std::string>{"3.1", "3.12"}));
  EXPECT_TRUE(checkEquations({"gdd/goal.hpp", {"/// (3.1) and (3.12)"}}, theory).empty());
  EXPECT_TRUE(checkEquations({"gdd/goal.hpp", {"y = std::sqrt(3.5);  // (3.1)"}}, theory).empty());
  EXPECT_EQ(checkEquations({"gdd/goal.hpp", {"/// (3.1), (3.2), (3.3)"}}, theory).size(), 2u);
}

TEST(SourceRules, StrangersAtTheRootAreFound) {
  EXPECT_TRUE(checkRoot({"engine", "dev", ".git", "build"}).empty());
  EXPECT_EQ(checkRoot({"engine", "scratch.txt", "src"}).size(), 2u);
}

}  // namespace
}  // namespace softgauss::test
