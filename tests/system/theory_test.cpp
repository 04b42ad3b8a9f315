// SPDX-License-Identifier: Apache-2.0
/// The theory says where each of its equations comes from, every decision is in the index, and what
/// pages call by name is in the code.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

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

/// Words of the files that are code.
std::vector<std::set<std::string>> wordsOfCode() {
  std::vector<std::set<std::string>> all;
  for (const SourceFile& file : tree()) {
    if (!file.isCode()) continue;
    std::set<std::string>& words = all.emplace_back();
    for (const std::string& line : file.lines) {
      std::string word;
      for (const char c : line + "\n") {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
          word += c;
        } else if (!word.empty()) {
          words.insert(std::exchange(word, {}));
        }
      }
    }
  }
  return all;
}

// `Scope::name` is in a file that has both words, `name()` in any. Decisions tell what was, the
// page on rivals what others have; `mine` is the reader's.
TEST(Docs, NameWhatIsInTheCode) {
  const std::vector<std::set<std::string>> files = wordsOfCode();
  const auto together = [&](const std::string& a, const std::string& b) {
    return std::any_of(files.begin(), files.end(), [&](const std::set<std::string>& words) {
      return words.count(a) == 1 && words.count(b) == 1;
    });
  };
  const std::regex scoped(R"(\b((?:[A-Za-z]\w*::)+[A-Za-z]\w*))"), last(R"((\w+)::(\w+)$)");
  const std::regex called(R"(`(?:\w+[.:])*([A-Za-z]\w*)\(\)`)");
  std::size_t seen = 0;
  for (const SourceFile& file : filesBelow("docs/")) {
    if (!file.path.ends_with(".md") || file.path.starts_with("docs/decisions/") ||
        file.path == "docs/rivals.md")
      continue;
    const std::string text = wholeText(file);
    for (const std::string& name : matchesIn(text, scoped)) {
      std::smatch parts;
      if (name.starts_with("std::") || name.ends_with("::mine")) continue;
      ASSERT_TRUE(std::regex_search(name, parts, last));
      EXPECT_TRUE(together(parts[1], parts[2])) << file.path << ": " << name;
      ++seen;
    }
    for (const std::string& name : matchesIn(text, called)) {
      EXPECT_TRUE(together(name, name)) << file.path << ": " << name << "()";
      ++seen;
    }
  }
  EXPECT_GT(seen, 50u);
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
