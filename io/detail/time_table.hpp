// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A table of comma-separated values over time that is read row by row: its column time_s rises.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "softgauss/io/detail/csv.hpp"

namespace softgauss::io::detail {

class TimeTable {
 public:
  /// `expected`: the columns in words, as messages have it. Everything throws ModelError with file
  /// and line.
  TimeTable(const std::filesystem::path& file, const std::string& expected);
  TimeTable(const TimeTable&) = delete;
  TimeTable& operator=(const TimeTable&) = delete;

  const std::vector<std::string>& header() const { return header_; }
  std::optional<std::size_t> find(const std::string& column) const;

  /// Goes to the next row; false behind the last. There must be one.
  bool next();
  double time() const { return time_; }  ///< of the row [s]
  int line() const { return reader_.line(); }
  bool isEmpty(std::size_t column) const { return (*row_)[column].empty(); }
  double number(std::size_t column) const;

  /// At the present row, or at another line.
  [[noreturn]] void fail(const std::string& element, const std::string& problem) const {
    fail(line(), element, problem);
  }
  [[noreturn]] void fail(int line, const std::string& element, const std::string& problem) const;

 private:
  std::string name_, text_;
  CsvReader reader_;
  std::vector<std::string> header_;
  std::size_t timeColumn_ = 0;
  const std::vector<std::string>* row_ = nullptr;
  std::optional<double> last_;
  double time_ = 0.0;
};

}  // namespace softgauss::io::detail
