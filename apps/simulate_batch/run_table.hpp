// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The rows of runs.csv, in whatever order they come, and the file that keeps those that are done.
///
/// The checkpoint is a line that names the sweep, then a line a run: number, CPU seconds, row. A
/// line that was cut off, as kill -9 leaves the last one, is not read.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace softgauss::app {

struct RunRow {
  long run = -1;
  double seconds = 0.0;  ///< of CPU time
  std::string text;      ///< without the line's end
};

class RunTable {
 public:
  RunTable(std::string header, long runs);
  ~RunTable();

  /// Reads what is done and keeps on writing there. `origin` names the sweep and all that its rows
  /// depend on. Throws ModelError where the file is of another sweep or cannot be written.
  void keepIn(const std::filesystem::path& checkpoint, const std::string& origin);
  /// A run that is there already is not taken again. Throws std::runtime_error where the checkpoint
  /// cannot be written.
  void add(RunRow row);
  bool has(long run) const { return rows_[static_cast<std::size_t>(run)].run >= 0; }
  long done() const { return done_; }
  long runs() const { return static_cast<long>(rows_.size()); }
  const std::vector<RunRow>& rows() const { return rows_; }
  std::vector<long> missing() const;

  /// Throws ModelError and std::runtime_error where it cannot be written.
  void write(const std::filesystem::path& csv) const;
  const std::string& header() const { return header_; }

 private:
  void place(RunRow row);

  std::string header_;
  std::vector<RunRow> rows_;
  long done_ = 0;
  std::FILE* checkpoint_ = nullptr;
  std::string checkpointName_;
};

/// A field as it stands in a row: in quotes where it has to be.
std::string csvField(const std::string& text);
/// Fields of a row, without their quotes.
std::vector<std::string> fieldsOf(const std::string& row);

}  // namespace softgauss::app
