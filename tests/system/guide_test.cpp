// SPDX-License-Identifier: Apache-2.0
/// What users read: the glossary knows every name that they meet, links lead somewhere, pages are
/// short and free of equation numbers, and the C++ of the guide is that of a test.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "tests/system/source_rules.hpp"

namespace softgauss::test {
namespace {

using NameSet = std::set<std::string>;

std::string joinedLines(const SourceFile& file) {
  std::string text;
  for (const std::string& line : file.lines) text += line + "\n";
  return text;
}

std::string pageText(const std::string& path) {
  for (const SourceFile& file : tree())
    if (file.path == path) return joinedLines(file);
  ADD_FAILURE() << path << " is missing";
  return {};
}

NameSet allMatches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  NameSet found;
  for (std::sregex_iterator m(text.begin(), text.end(), expression), end; m != end; ++m)
    found.insert((*m)[1]);
  return found;
}

/// The members of a struct that begin a line: `type name = value;`, with two blanks before.
NameSet membersOf(const std::string& text, const std::string& name) {
  const std::size_t begin = text.find("struct " + name + " {");
  if (begin == std::string::npos) return {};
  const std::string body = text.substr(begin, text.find("\n};", begin) - begin);
  return allMatches(body, R"(\n  [\w:]+ (\w+)(?: = [^;\n]*)?;)");
}

bool isUserPage(const std::string& path) {
  return path.starts_with("docs/guide/") || path.starts_with("docs/reference/") ||
         path == "README.md" || path == "docs/README.md" || path == "docs/glossary.md" ||
         path == "docs/limits.md";
}

/// Lines outside of fenced blocks, without what stands between back-ticks.
std::vector<std::string> proseOf(const SourceFile& file) {
  static const std::regex code("`[^`]*`");
  std::vector<std::string> prose;
  bool fenced = false;
  for (const std::string& line : file.lines) {
    if (line.starts_with("```")) fenced = !fenced;
    prose.push_back(fenced ? "" : std::regex_replace(line, code, ""));
  }
  return prose;
}

// ---- The glossary -------------------------------------------------------------------------------

/// Names in back-ticks and terms in bold.
NameSet glossaryTerms(const std::string& glossary) {
  NameSet terms = allMatches(glossary, "`([^`\n]+)`");
  terms.merge(allMatches(glossary, R"(\*\*([^*\n]+)\*\*)"));
  return terms;
}

void expectKnown(const NameSet& names, std::size_t least, const std::string& where) {
  static const NameSet terms = glossaryTerms(pageText("docs/glossary.md"));
  EXPECT_GE(names.size(), least) << where << " is not read as it should be";
  for (const std::string& name : names)
    EXPECT_TRUE(terms.count(name) > 0) << where << ": docs/glossary.md lacks `" << name << "`";
}

TEST(Glossary, KnowsOptionsAndCounters) {
  expectKnown(membersOf(pageText("engine/model/model.hpp"), "Options"), 15, "Options");
  expectKnown(membersOf(pageText("engine/step/data.hpp"), "StepStats"), 20, "StepStats");
}

TEST(Glossary, KnowsEffectsAndMechanisms) {
  const std::string named = R"re(::\w+,\s*"(\w+)")re";
  expectKnown(allMatches(pageText("engine/model/effects.hpp"), "\\{Effect" + named), 15, "effects");
  expectKnown(allMatches(pageText("engine/model/mechanisms.hpp"), "\\{Mechanism" + named), 9,
              "mechanisms");
}

TEST(Glossary, KnowsTheCommandLine) {
  NameSet options;
  for (const SourceFile& file : tree())
    if (file.path.starts_with("apps/simulate_gdd/") && file.path.ends_with(".cpp"))
      options.merge(
          allMatches(joinedLines(file), R"re(add_(?:option|flag)\(\s*"(--[a-z0-9-]+))re"));
  expectKnown(options, 40, "options of simulate_gdd");
}

TEST(Glossary, KnowsTheSummary) {
  const std::string source = pageText("io/summary.cpp");
  NameSet keys = allMatches(source, R"re(\{"(\w+)",)re");
  keys.merge(allMatches(source, R"re(\["(\w+)"( \+ suffix)?\] =)re"));
  expectKnown(keys, 80, "keys of the summary");
}

/// Words of headings that are plain English.
const NameSet kPlainWords = {
    "a",          "accuracy", "an",         "and",        "ask",      "asked",    "at",
    "balance",    "believe",  "between",    "body",       "bounce",   "but",      "c",
    "can",        "choosing", "code",       "comes",      "command",  "commands", "configuration",
    "controller", "cost",     "did",        "differ",     "do",       "does",     "down",
    "drift",      "errors",   "examples",   "exit",       "explodes", "falls",    "fast",
    "feet",       "file",     "finite",     "first",      "fixed",    "floating", "for",
    "more",       "four",     "from",       "goes",       "grip",     "guide",    "hand",
    "how",        "hums",     "i",          "in",         "initial",  "install",  "integrator",
    "is",         "it",       "joints",     "known",      "large",    "lies",     "line",
    "link",       "looks",    "many",       "minutes",    "much",     "mujoco",   "my",
    "never",      "next",     "no",         "non",        "not",      "of",       "on",
    "once",       "or",       "over",       "overshoots", "own",      "parts",    "passes",
    "pick",       "place",    "program",    "pushes",     "reach",    "reached",  "reaches",
    "reading",    "refuses",  "repeat",     "rest",       "results",  "run",      "runs",
    "say",        "shakes",   "simulation", "sinks",      "slide",    "slow",     "slowly",
    "small",      "solver",   "something",  "stand",      "state",    "suffice",  "summary",
    "surfaces",   "swing",    "take",       "ten",        "that",     "the",      "through",
    "time",       "to",       "too",        "try",        "two",      "under",    "uses",
    "walk",       "wall",     "warnings",   "ways",       "what",     "when",     "where",
    "which",      "without",  "wrong",      "your"};

NameSet headingWords(const SourceFile& page) {
  static const std::regex heading("#+ (.*)");
  NameSet words;
  for (const std::string& line : proseOf(page)) {
    std::smatch match;
    if (!std::regex_match(line, match, heading)) continue;
    std::string text = match[1];
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    words.merge(allMatches(text, "([a-z]+)"));
  }
  return words;
}

TEST(Glossary, KnowsTheWordsOfHeadings) {
  std::string glossary = pageText("docs/glossary.md");
  std::transform(glossary.begin(), glossary.end(), glossary.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const NameSet known = allMatches(glossary, "([a-z]+)");
  std::size_t seen = 0;
  for (const SourceFile& file : tree()) {
    if (!file.path.starts_with("docs/guide/")) continue;
    for (const std::string& word : headingWords(file)) {
      ++seen;
      // The singular will do.
      const std::string one = word.ends_with('s') ? word.substr(0, word.size() - 1) : word;
      EXPECT_TRUE(kPlainWords.count(word) + known.count(word) + known.count(one) > 0)
          << file.path << ": a heading has '" << word << "', which docs/glossary.md lacks";
    }
  }
  EXPECT_GT(seen, 50u);
}

TEST(Glossary, IsReadAsItIsWritten) {
  EXPECT_EQ(glossaryTerms("- **cone**, `a_b`: text `--c`\n"), (NameSet{"cone", "a_b", "--c"}));
  EXPECT_EQ(membersOf("struct S {\n  int a = 3;  ///< x\n  VectorX b;\n  bool f() {\n    int c;\n"
                      "  }\n};\nstruct T {\n  int d;\n};\n",
                      "S"),
            (NameSet{"a", "b"}));
  EXPECT_EQ(headingWords({"a.md", {"# The Step", "text", "```", "# code", "```", "## `x` y"}}),
            (NameSet{"the", "step", "y"}));
}

// ---- Links --------------------------------------------------------------------------------------

/// The anchor of a heading: lower case, blanks as hyphens, without punctuation.
std::string anchorOf(const std::string& heading) {
  std::string anchor;
  for (const char c : heading) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == ' ') anchor += '-';
    if (std::isalnum(byte) || c == '-' || c == '_' || byte >= 0x80)
      anchor += static_cast<char>(std::tolower(byte));
  }
  return anchor;
}

NameSet anchorsOf(const SourceFile& page) {
  NameSet anchors;
  bool fenced = false;
  for (const std::string& line : page.lines) {
    if (line.starts_with("```")) fenced = !fenced;
    const std::size_t level = line.find_first_not_of('#');
    if (!fenced && level != std::string::npos && level > 0 && line[level] == ' ')
      anchors.insert(anchorOf(line.substr(level + 1)));
  }
  return anchors;
}

/// Links of a page that lead nowhere. `pages`: all pages by their path.
Complaints deadLinks(const SourceFile& page,
                     const std::map<std::string, const SourceFile*>& pages) {
  static const std::regex link(R"(\]\(([^)\s]+)\))");
  Complaints complaints;
  for (const std::string& line : proseOf(page))
    for (std::sregex_iterator m(line.begin(), line.end(), link), end; m != end; ++m) {
      const std::string target = (*m)[1];
      if (target.starts_with("http")) continue;
      const std::size_t hash = target.find('#');
      const std::string file = target.substr(0, hash);
      const std::filesystem::path folder = std::filesystem::path(page.path).parent_path();
      const std::string path =
          file.empty() ? page.path : (folder / file).lexically_normal().generic_string();
      const auto found = pages.find(path);
      const bool exists =
          found != pages.end() ||
          std::filesystem::exists(std::filesystem::path(SOFTGAUSS_SOURCE_DIR) / path);
      if (!exists) complaints.push_back(page.path + ": no " + target);
      if (found != pages.end() && hash != std::string::npos &&
          anchorsOf(*found->second).count(target.substr(hash + 1)) == 0)
        complaints.push_back(page.path + ": no heading for " + target);
    }
  return complaints;
}

TEST(Docs, LinksLeadSomewhere) {
  std::map<std::string, const SourceFile*> pages;
  for (const SourceFile& file : tree())
    if (file.path.ends_with(".md")) pages[file.path] = &file;
  EXPECT_GT(pages.size(), 30u);
  for (const auto& [path, page] : pages)
    for (const std::string& complaint : deadLinks(*page, pages)) ADD_FAILURE() << complaint;
}

TEST(Docs, DeadLinksAreFound) {
  const SourceFile page{"docs/a.md",
                        {"[x](b.md#one-two) [y](b.md#three) [z](nowhere.md) `[q](r)`"}};
  const SourceFile other{"docs/b.md", {"## One, two"}};
  EXPECT_EQ(deadLinks(page, {{page.path, &page}, {other.path, &other}}).size(), 2u);
}

// ---- User pages ---------------------------------------------------------------------------------

TEST(UserPages, AreShortAndWithoutEquationNumbers) {
  std::size_t words = 0;
  for (const SourceFile& file : tree()) {
    if (!isUserPage(file.path)) continue;
    std::istringstream text(joinedLines(file));
    for (std::string word; text >> word;) ++words;
    EXPECT_TRUE(equationsIn(file).empty()) << file.path;
  }
  EXPECT_GT(words, 5000u);
  EXPECT_LE(words, 20000u);
}

/// Lines of C++ blocks, without what is before and after on a line; but for includes and main.
std::vector<std::string> cppLines(const SourceFile& page) {
  std::vector<std::string> lines;
  bool inside = false;
  for (const std::string& line : page.lines) {
    if (line.starts_with("```")) inside = line == "```cpp";
    const std::size_t begin = line.find_first_not_of(' ');
    if (!inside || begin == std::string::npos || line.starts_with("```")) continue;
    if (line.starts_with("#include") || line.starts_with("int main()")) continue;
    lines.push_back(line.substr(begin));
  }
  return lines;
}

TEST(UserPages, CppIsThatOfATest) {
  NameSet tested;
  for (const SourceFile& file : tree())
    if (file.path == "tests/simulation/guide_test.cpp")
      for (const std::string& line : file.lines)
        tested.insert(line.substr(std::min(line.find_first_not_of(' '), line.size())));
  std::size_t lines = 0;
  for (const SourceFile& file : tree()) {
    if (file.path != "docs/guide/cpp.md" && file.path != "README.md") continue;
    for (const std::string& line : cppLines(file)) {
      ++lines;
      EXPECT_TRUE(tested.count(line) > 0) << file.path << ": in no test: " << line;
    }
  }
  EXPECT_GT(lines, 40u);
}

}  // namespace
}  // namespace softgauss::test
