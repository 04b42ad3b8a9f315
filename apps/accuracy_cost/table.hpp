// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Results as a CSV file, which an interrupted run continues.

#include <filesystem>
#include <fstream>
#include <vector>

#include "apps/accuracy_cost/study.hpp"

namespace softgauss::app {

class ResultTable {
 public:
  /// Reads what the file holds, and appends to it. A file of another version of the table is kept
  /// beside it, with `.old`. Throws std::runtime_error when it cannot be written.
  /// The results of the problem `anew` are left out.
  explicit ResultTable(std::filesystem::path file, const std::string& anew = {});

  /// What was given up counts only where it had `mostTime` or more [CPU s per simulated s].
  bool has(const std::string& problem, const Method& method, double h, double mostTime);
  /// In the place of an older one of the same setting.
  void add(const Result& result);
  const std::vector<Result>& results() const { return results_; }

 private:
  std::vector<Result>::iterator find(const std::string& problem, const Method& method, double h);
  void put(const Result& result);

  std::vector<Result> results_;
  std::ofstream out_;
};

}  // namespace softgauss::app
