// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A file that appears only when it is complete: written beside its place, then renamed.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace softgauss::io::detail {

class OutputFile {
 public:
  /// Opens `file`.part, or the file itself where that is a device or a pipe. `what` names the
  /// output in messages. Throws ModelError if it cannot be opened.
  OutputFile(const std::filesystem::path& file, const std::string& what);
  /// What was not committed leaves no trace; an earlier file of that name is as it was.
  ~OutputFile();
  OutputFile(OutputFile&&) noexcept = default;
  OutputFile& operator=(OutputFile&&) = delete;

  void write(std::string_view text);
  /// Throws std::runtime_error if the disk is full or gone.
  void commit();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  [[noreturn]] void fail() const;

  std::filesystem::path target_, written_;
  std::string what_;
  std::unique_ptr<std::FILE, Closer> file_;
  bool good_ = true;
};

}  // namespace softgauss::io::detail
