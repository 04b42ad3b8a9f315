// SPDX-License-Identifier: Apache-2.0
/// The theory says where each of its equations comes from, and every decision is in the index.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "tests/system/source_rules.hpp"

namespace softgauss::test {
namespace {

constexpr std::size_t kMostOfDecision = 600, kMostOfChapter = 2500, kMostOfTheory = 15000;

std::size_t wordsIn(const SourceFile& file) {
  std::size_t words = 0;
  for (const std::string& line : file.lines) {
    std::istringstream stream(line);
    words += static_cast<std::size_t>(std::distance(std::istream_iterator<std::string>(stream),
                                                    std::istream_iterator<std::string>()));
  }
  return words;
}

std::string wholeText(const SourceFile& file) {
  std::string text;
  for (const std::string& line : file.lines) text += line + "\n";
  return text;
}

std::vector<SourceFile> filesBelow(const std::string& folder) {
  std::vector<SourceFile> files;
  std::copy_if(tree().begin(), tree().end(), std::back_inserter(files),
               [&](const SourceFile& file) { return file.path.starts_with(folder); });
  return files;
}

/// What each match of the pattern's first group is.
std::set<std::string> matchesIn(const std::string& text, const std::regex& pattern) {
  std::set<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), pattern), end; it != end; ++it)
    found.insert((*it)[1]);
  return found;
}

/// Equations that a table of sources has: (3.1), or all from (3.5) to (3.7).
std::set<std::string> equationsOfSources(const std::string& table) {
  static const std::regex number(R"(\((\d+\.\d+)\))");
  static const std::regex range(R"(\((\d+)\.(\d+)\) to \(\d+\.(\d+)\))");
  std::set<std::string> numbers = matchesIn(table, number);
  for (std::sregex_iterator it(table.begin(), table.end(), range), end; it != end; ++it)
    for (int n = std::stoi((*it)[2]); n <= std::stoi((*it)[3]); ++n)
      numbers.insert((*it)[1].str() + "." + std::to_string(n));
  return numbers;
}

TEST(Theory, IsShort) {
  std::size_t all = 0;
  for (const SourceFile& file : filesBelow("docs/theory/")) {
    EXPECT_LE(wordsIn(file), kMostOfChapter) << file.path;
    all += wordsIn(file);
  }
  EXPECT_GT(all, 0u);
  EXPECT_LE(all, kMostOfTheory);
}

TEST(Theory, EquationsNameTheirSource) {
  for (const SourceFile& file : filesBelow("docs/theory/")) {
    if (!isChapterOfTheory(file)) continue;
    const std::string text = wholeText(file);
    const std::size_t begin = text.find("## Sources");
    const std::set<std::string> own = equationsOfChapter(file);
    if (own.empty()) continue;
    ASSERT_NE(begin, std::string::npos) << file.path;
    const std::set<std::string> sources = equationsOfSources(text.substr(begin));
    for (const std::string& number : own)
      EXPECT_EQ(sources.count(number), 1u) << file.path << ": (" << number << ") has no source";
  }
}

TEST(Theory, CitesLiteratureThatIsListed) {
  std::ifstream stream(std::string(SOFTGAUSS_SOURCE_DIR) + "/docs/references.bib");
  const std::string bib{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const std::set<std::string> keys = matchesIn(bib, std::regex(R"(@\w+\{(\w+),)"));
  ASSERT_FALSE(keys.empty());
  // [Key2008], [Key2008, Other2015]; no link, which is followed by its target.
  const std::regex citation(R"(\[((?:[A-Z]\w*\d{4})(?:, [A-Z]\w*\d{4})*)\](?!\())");
  const std::regex key(R"(([A-Z]\w*\d{4}))");
  for (const char* folder : {"docs/theory/", "docs/decisions/"})
    for (const SourceFile& file : filesBelow(folder))
      for (const std::string& cited : matchesIn(wholeText(file), citation))
        for (const std::string& name : matchesIn(cited, key))
          EXPECT_EQ(keys.count(name), 1u) << file.path << ": [" << name << "]";
}

TEST(Decisions, AreInTheIndex) {
  const std::string folder = "docs/decisions/", index = folder + "README.md";
  std::set<std::string> pages, listed;
  for (const SourceFile& file : filesBelow(folder)) {
    if (file.path == index)
      listed = matchesIn(wholeText(file), std::regex(R"(\]\((\d{4}-[a-z0-9-]+\.md)\))"));
    else
      pages.insert(file.path.substr(folder.size()));
  }
  EXPECT_FALSE(pages.empty());
  EXPECT_EQ(listed, pages);
}

TEST(Decisions, AreShort) {
  for (const SourceFile& file : filesBelow("docs/decisions/0"))
    EXPECT_LE(wordsIn(file), kMostOfDecision) << file.path;
}

}  // namespace
}  // namespace softgauss::test
