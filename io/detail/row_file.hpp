// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A table of comma-separated values that is written row by row while a run goes on.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/core/types.hpp"
#include "softgauss/io/detail/output_file.hpp"

namespace softgauss::io::detail {

/// Rows are buffered; what was written is on disk after flush(), close() or the end of its life.
class RowFile {
 public:
  /// `what` names the table in messages. `after`: end() of the rows of an earlier process, which
  /// these go on from; what comes later is cut off. Throws ModelError if the file cannot be made,
  /// or is not what was written then.
  RowFile(const std::filesystem::path& file, std::string what,
          const std::vector<std::string>& columns, std::optional<std::int64_t> after = {});
  ~RowFile();
  RowFile(RowFile&&) noexcept = default;
  RowFile& operator=(RowFile&&) = delete;

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
  void flush();
  void close();
  /// Flushes. How long the file is [bytes]; −1 of a device, a pipe or standard output.
  std::int64_t end();

 private:
  void next() {
    if (!rowIsEmpty_) buffer_ += ',';
    rowIsEmpty_ = false;
  }
  [[noreturn]] void refuse() const;
  [[noreturn]] void failed() const;
  bool send() noexcept;
  void goOn(const std::string& header, std::int64_t after);

  std::string path_, what_;
  OpenFile file_;
  std::string buffer_;
  bool rowIsEmpty_ = true;
};

}  // namespace softgauss::io::detail
