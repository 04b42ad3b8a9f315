// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a run of simulate_gdd did, and whether what must hold does.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/run_cases/case_file.hpp"

namespace softgauss::cases {

struct Outcome {
  int exitCode = -1;                                   ///< 128 + signal when a signal ended it
  std::string said;                                    ///< standard output, then standard error
  std::map<std::string, std::vector<double>> columns;  ///< of the log, but for its last row's zeros
  std::string summary;                                 ///< JSON
};

/// Runs the program in the case's folder; outputs go to `scratch`. More than five minutes of
/// processor time are an endless run.
Outcome run(const std::filesystem::path& program, const Case& of, const Run& run,
            const std::filesystem::path& scratch);

/// What was found, where it does not hold; nothing where it does.
std::string broken(const Expectation& expectation, const Outcome& outcome);

}  // namespace softgauss::cases
