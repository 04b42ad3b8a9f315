// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A case: what is run, and what must hold of it, as its file case.yaml says (docs/testing.md).

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace softgauss::cases {

/// What of the numbers of a column is looked at.
enum class Take {
  first,
  last,
  least,
  greatest,
  size,  ///< the largest absolute value
  span   ///< greatest less least
};

/// One thing that must hold. Exactly one of exitCode, says, saysNot and of is given.
struct Expectation {
  std::optional<int> exitCode;
  std::string says, saysNot;  ///< words of standard output or standard error
  std::string of;             ///< a column of the log, or `summary:` and the path of a number in it
  Take take = Take::last;     ///< of a column
  std::optional<double> atLeast, atMost;
  std::string text;  ///< as the table shows it
};

struct Run {
  std::vector<std::string> arguments;  ///< of simulate_gdd, in the folder of the case
  std::vector<Expectation> expectations;

  bool readsLog() const;
  bool readsSummary() const;
};

struct Case {
  std::string name;  ///< of its folder, below that of all cases
  std::filesystem::path folder;
  std::string what;  ///< the law, in a sentence
  std::vector<Run> runs;
};

/// The cases below a folder, by name. Throws ModelError where a file is not as it should be.
std::vector<Case> readCases(const std::filesystem::path& folder);

}  // namespace softgauss::cases
