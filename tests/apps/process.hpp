// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Runs a program as a user does: a process with arguments, an exit code and two outputs.

#include <string>
#include <vector>

#include "tests/io/temp_folder.hpp"

namespace softgauss::test {

struct Outcome {
  int exitCode = -1;  ///< 128 + signal when a signal ended it
  std::string out;    ///< standard output
  std::string err;    ///< standard error
};

/// Runs a program of apps/ to its end. With `interruptAfter` ≥ 0 it gets SIGINT that long after it
/// has created `interruptFile` [s].
Outcome runProgram(const std::string& name, const std::vector<std::string>& arguments,
                   double interruptAfter = -1.0, const std::string& interruptFile = {});

/// The same of simulate_gdd.
Outcome simulate(const std::vector<std::string>& arguments, double interruptAfter = -1.0,
                 const std::string& interruptFile = {});

/// The same of a program that is started in a folder.
Outcome runProgramIn(const std::string& folder, const std::string& name,
                     const std::vector<std::string>& arguments);

/// Commands of a shell, started in a folder, which finds the programs of apps/.
Outcome runShell(const std::string& folder, const std::string& commands);

std::string readFile(const std::string& path);

/// A file of data/ or of its subfolders.
std::string dataFile(const std::string& path);

/// Arguments of simulate_gdd: the arm, left to itself for `duration` [s].
std::vector<std::string> passiveArm(const std::string& duration);

/// A table of numbers with a header, as --log writes it.
struct Csv {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< as written

  explicit Csv(const std::string& text);
  int find(const std::string& column) const;  ///< index or −1
  double number(int row, const std::string& column) const;
};

}  // namespace softgauss::test
