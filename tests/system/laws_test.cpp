// SPDX-License-Identifier: Apache-2.0
/// Every law of docs/testing.md has the test that the page names for it.

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "tests/system/source_rules.hpp"

namespace softgauss::test {
namespace {

std::string textOf(const SourceFile& file) {
  std::string text;
  for (const std::string& line : file.lines) text += line + "\n";
  return text;
}

/// "Suite.Name" of every test below tests/.
std::set<std::string> namesOfTests() {
  static const std::regex test(
      R"(\nTEST(?:_F|_P)?\((\w+),\s*(\w+)\)|\nTYPED_TEST\((\w+),\s*(\w+)\))");
  std::set<std::string> names;
  for (const SourceFile& file : tree()) {
    if (!file.path.ends_with("_test.cpp")) continue;
    const std::string text = textOf(file);
    for (std::sregex_iterator m(text.begin(), text.end(), test), end; m != end; ++m)
      names.insert((*m)[1].str() + (*m)[3].str() + "." + (*m)[2].str() + (*m)[4].str());
  }
  return names;
}

/// The tests named in the table of laws, as beginnings of "Suite.Name" where they end in an
/// ellipsis.
struct NamedTest {
  std::string name;
  bool isBeginning;
};

std::vector<NamedTest> testsOfLaws(const std::string& page) {
  const std::size_t begin = page.find("## The laws"), end = page.find("\n## ", begin);
  const std::string table = page.substr(begin, end - begin);
  static const std::regex named("`(?:\\w+/)?(\\w+\\.\\w*)((?:…)?)`");
  std::vector<NamedTest> tests;
  for (std::sregex_iterator m(table.begin(), table.end(), named), last; m != last; ++m)
    tests.push_back({(*m)[1], (*m)[2].length() > 0});
  return tests;
}

bool exists(const NamedTest& test, const std::set<std::string>& names) {
  const auto found = names.lower_bound(test.name);
  return found != names.end() &&
         (test.isBeginning ? found->starts_with(test.name) : *found == test.name);
}

TEST(TableOfLaws, NamesTestsThatExist) {
  const std::set<std::string> names = namesOfTests();
  const auto page = std::find_if(tree().begin(), tree().end(), [](const SourceFile& file) {
    return file.path == "docs/testing.md";
  });
  ASSERT_NE(page, tree().end());
  const std::vector<NamedTest> laws = testsOfLaws(textOf(*page));
  EXPECT_GT(laws.size(), 25u);
  for (const NamedTest& law : laws) EXPECT_TRUE(exists(law, names)) << law.name;
}

TEST(TableOfLaws, MissesATestThatIsGone) {
  const std::set<std::string> names{"Crba.IsPositive", "Rnea.InvertsAba"};
  const std::vector<NamedTest> laws = testsOfLaws(
      "## The laws\n| a | `Crba.…`, `Rnea.InvertsAba` |\n| b | `Aba.…`, `Rnea.Inverts` |\n");
  ASSERT_EQ(laws.size(), 4u);
  EXPECT_TRUE(exists(laws[0], names) && exists(laws[1], names));
  EXPECT_FALSE(exists(laws[2], names) || exists(laws[3], names));
}

}  // namespace
}  // namespace softgauss::test
