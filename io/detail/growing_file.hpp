// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A file that is written from its beginning on while a run goes on.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "softgauss/io/detail/output_file.hpp"

namespace softgauss::io::detail {

/// What is appended is buffered; it is on disk after flush(), close() or the end of its life.
class GrowingFile {
 public:
  /// `what` names the file in messages. `beginning`: what every such file begins with. `after`:
  /// end() of an earlier process, which this one goes on from; what comes later is cut off. Throws
  /// ModelError if the file cannot be made, or is not what was written then.
  GrowingFile(const std::filesystem::path& file, std::string what, const std::string& beginning,
              std::optional<std::int64_t> after = {});
  ~GrowingFile();
  GrowingFile(GrowingFile&&) noexcept = default;
  GrowingFile& operator=(GrowingFile&&) = delete;

  /// Texts are appended to it; sendIfFull() follows.
  std::string& buffer() { return buffer_; }

  /// These throw std::runtime_error if the disk is full or gone.
  void sendIfFull();
  void flush();
  void close();
  /// Flushes. How long the file is [bytes]; −1 of a device, a pipe or standard output.
  std::int64_t end();

 private:
  [[noreturn]] void refuse() const;
  [[noreturn]] void failed() const;
  bool send() noexcept;
  void goOn(const std::string& beginning, std::int64_t after);

  std::string path_, what_;
  OpenFile file_;
  std::string buffer_;
};

}  // namespace softgauss::io::detail
