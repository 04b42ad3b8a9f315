// SPDX-License-Identifier: Apache-2.0
/// Every row of table.txt: bad input ends with its exit code and a message that says what is wrong.
/// A case is added by a file in files/ and a row, or by a row alone.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

namespace fs = std::filesystem;

const std::string kFolder = std::string(SOFTGAUSS_SOURCE_DIR) + "/tests/bad_input/";
const std::string kFiles = kFolder + "files/";

struct Row {
  int line = 0;
  std::vector<std::string> arguments;
  int exitCode = -1;
  std::vector<std::string> words;
};

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' '), end = text.find_last_not_of(' ');
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(trimmed(part));
  return parts;
}

/// Arguments between blanks, or in quotes.
std::vector<std::string> argumentsOf(const std::string& text) {
  std::vector<std::string> arguments;
  bool quoted = false, open = false;
  for (const char c : text) {
    if (c == '"') {
      quoted = !quoted;
      if (!open) arguments.emplace_back();
      open = true;
    } else if (c == ' ' && !quoted) {
      open = false;
    } else {
      if (!open) arguments.emplace_back();
      open = true;
      arguments.back() += c;
    }
  }
  return arguments;
}

std::vector<Row> rows() {
  std::vector<Row> table;
  std::ifstream in(kFolder + "table.txt");
  int number = 0;
  for (std::string text; std::getline(in, text);) {
    ++number;
    if (text.empty() || text[0] == '#') continue;
    const std::vector<std::string> fields = split(text, '|');
    EXPECT_EQ(fields.size(), 3u) << "table.txt:" << number << ": " << text;
    if (fields.size() != 3) continue;
    table.push_back(
        {number, argumentsOf(fields[0]), std::atoi(fields[1].c_str()), split(fields[2], ';')});
  }
  return table;
}

/// Processor time of all programs that have ended [s]: other work on the machine does not count.
double childSeconds() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// No command of the table may leave anything behind.
std::set<std::string> namesIn(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    names.insert(fs::relative(entry.path(), folder));
  return names;
}

TEST(BadInputTable, EachRowEndsWithItsCodeAndWords) {
  const std::vector<Row> table = rows();
  ASSERT_GE(table.size(), 200u);
  const std::set<std::string> before = namesIn(kFiles);
  for (const Row& row : table) {
    const double start = childSeconds();
    const Outcome outcome = runProgramIn(kFiles, "simulate_gdd", row.arguments);
    const double seconds = childSeconds() - start;
    const std::string place = "table.txt:" + std::to_string(row.line);
    EXPECT_EQ(outcome.exitCode, row.exitCode) << place << "\n" << outcome.err;
    ASSERT_FALSE(row.words.empty()) << place;
    for (const std::string& word : row.words)
      EXPECT_NE(outcome.err.find(word), std::string::npos) << place << ": no '" << word << "' in\n"
                                                           << outcome.err;
    EXPECT_LT(outcome.err.size(), 3000u) << place << ": long\n" << outcome.err;
    EXPECT_LT(seconds, 10.0) << place;
    for (const char c : outcome.err)
      ASSERT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20) << place;
    if (row.exitCode == 0) continue;
    EXPECT_EQ(outcome.out, "") << place;
  }
  EXPECT_EQ(namesIn(kFiles), before);
}

// A file that nothing reads is no case.
TEST(BadInputTable, NamesEveryFile) {
  std::ifstream in(kFolder + "table.txt");
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  for (const auto& entry : fs::recursive_directory_iterator(kFiles)) {
    if (!entry.is_regular_file()) continue;
    const std::string name = fs::relative(entry.path(), kFiles);
    // Landscapes, meshes and robots are named by a scene or a URDF.
    bool named = text.find(name) != std::string::npos;
    for (const auto& other : fs::recursive_directory_iterator(kFiles)) {
      const fs::path kind = other.path().extension();
      if (named || (kind != ".yaml" && kind != ".urdf")) continue;
      std::ifstream file(other.path());
      const std::string content((std::istreambuf_iterator<char>(file)),
                                std::istreambuf_iterator<char>());
      named = content.find(entry.path().filename().string()) != std::string::npos;
    }
    EXPECT_TRUE(named) << name;
  }
}

}  // namespace
}  // namespace softgauss::test
