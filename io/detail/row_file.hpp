// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A table of comma-separated values that is written row by row while a run goes on.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/core/types.hpp"
#include "softgauss/io/detail/growing_file.hpp"

namespace softgauss::io::detail {

class RowFile {
 public:
  /// As of a GrowingFile, which begins with the names of the columns.
  RowFile(const std::filesystem::path& file, std::string what,
          const std::vector<std::string>& columns, std::optional<std::int64_t> after = {});

  /// The next fields of the row. A number is the shortest text that reads back bit for bit.
  void add(double x);
  void add(int x);
  void add(const std::string& text);
  void add(const VectorX& values) {
    for (const double x : values) add(x);
  }
  void add(const Vector3& values) {
    for (const double x : values) add(x);
  }
  /// Fields without a value.
  void addEmpty(Eigen::Index count) {
    for (Eigen::Index i = 0; i < count; ++i) next();
  }

  /// These throw std::runtime_error if the disk is full or gone.
  void endRow();
  void flush() { file_.flush(); }
  void close() { file_.close(); }
  /// As of a GrowingFile.
  std::int64_t end() { return file_.end(); }

 private:
  void next() {
    if (!rowIsEmpty_) file_.buffer() += ',';
    rowIsEmpty_ = false;
  }

  GrowingFile file_;
  bool rowIsEmpty_ = true;
};

}  // namespace softgauss::io::detail
