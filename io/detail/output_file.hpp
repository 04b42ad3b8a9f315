// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A file that appears only when it is complete: written beside its place, then renamed.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace softgauss::io::detail {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, FileCloser>;

/// An open file descriptor, or none.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

 private:
  int number_;
};

/// Opens what is written from its beginning on and in its place: "-" is standard output, which a
/// file may be too; links are followed. Null where it cannot be opened, errno says why.
OpenFile openInPlace(const std::filesystem::path& file);

/// Devices, pipes and standard output, which cannot be renamed and begin nowhere.
bool isWrittenInPlace(const std::filesystem::path& file);

/// Writes to files and remembers the first error.
class OutputFile {
 public:
  /// `what` names the output in messages. Throws ModelError where the file could not be written;
  /// whatever is there stays as it is.
  OutputFile(const std::filesystem::path& file, const std::string& what);
  /// What was not committed leaves no trace; an earlier file of that name is as it was.
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;

  /// Opens a file beside `file`, where a link leads; a device, a pipe and standard output are
  /// written to in place.
  void write(std::string_view text);
  /// Throws std::runtime_error if the disk is full or gone, with the reason.
  void commit();

 private:
  void open();
  void note(bool done);
  [[noreturn]] void fail() const;

  std::filesystem::path target_;
  std::filesystem::path part_;  ///< that is being written; empty: none
  std::string what_;
  OpenFile file_;
  Descriptor lock_;  ///< says that the part is being written, until it has its name
  int error_ = 0;    ///< errno of the first that failed
};

/// Throws ModelError where `file` cannot be made or written, and leaves everything as it is.
void expectWritable(const std::filesystem::path& file, const std::string& what);

}  // namespace softgauss::io::detail
