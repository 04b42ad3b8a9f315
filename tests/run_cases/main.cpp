// SPDX-License-Identifier: Apache-2.0
/// run_cases SIMULATE_GDD FOLDER: runs every case below the folder and prints a table of what
/// holds. Exit code 0 where all of it does, 1 where something does not, 2 where there is nothing to
/// run.

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <exception>

#include "softgauss/engine/core/check.hpp"
#include "tests/run_cases/case_file.hpp"
#include "tests/run_cases/outcome.hpp"

namespace {

using namespace softgauss::cases;
namespace fs = std::filesystem;

/// Prints a line for each thing that must hold; how many do not.
int tell(const fs::path& program, const Case& each, const fs::path& scratch) {
  int failed = 0;
  fmt::print("{}: {}\n", each.name, each.what);
  for (const Run& of : each.runs) {
    const Outcome outcome = run(program, each, of, scratch);
    for (const Expectation& e : of.expectations) {
      const std::string found = broken(e, outcome);
      failed += found.empty() ? 0 : 1;
      fmt::print("  {}  {}{}{}\n", found.empty() ? "pass" : "FAIL", e.text,
                 found.empty() ? "" : "; found ", found);
    }
  }
  std::fflush(stdout);
  return failed;
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 3 || !fs::is_directory(arguments[2])) {
    std::fprintf(stderr, "usage: run_cases SIMULATE_GDD FOLDER\n");
    return 2;
  }
  const std::vector<Case> all = readCases(arguments[2]);
  if (all.empty()) {
    std::fprintf(stderr, "%s holds no case.yaml\n", arguments[2]);
    return 2;
  }
  const fs::path scratch =
      fs::temp_directory_path() / ("softgauss-cases-" + std::to_string(getpid()));
  int failed = 0;
  for (const Case& each : all)
    failed += tell(fs::absolute(arguments[1]), each, scratch) > 0 ? 1 : 0;
  fs::remove_all(scratch);
  fmt::print("{} of {} cases hold\n", all.size() - static_cast<std::size_t>(failed), all.size());
  return failed > 0 ? 1 : 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
