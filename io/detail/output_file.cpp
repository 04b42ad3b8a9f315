// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/output_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/part_files.hpp"
#include "softgauss/io/output.hpp"

namespace softgauss::io::detail {
namespace {

namespace fs = std::filesystem;

std::optional<struct stat> infoOf(const fs::path& file) {
  struct stat info = {};
  if (stat(file.c_str(), &info) != 0) return std::nullopt;
  return info;
}

/// Where standard output goes already: it would overwrite what another opening writes.
bool isStandardOutputsFile(const struct stat& info) {
  struct stat out = {};
  return S_ISREG(info.st_mode) && fstat(STDOUT_FILENO, &out) == 0 && out.st_dev == info.st_dev &&
         out.st_ino == info.st_ino;
}

/// Where links lead; the last part of the way need not exist.
fs::path withoutLinks(fs::path file) {
  constexpr int kMostLinks = 40;
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(file, error); ++i) {
    const fs::path next = fs::read_symlink(file, error);
    if (error) break;
    file = next.is_absolute() ? next : file.parent_path() / next;
  }
  return file;
}

/// Makes an empty file that was not there, and removes it. False: it cannot be made, errno says
/// why.
bool canBeMade(const fs::path& file) {
  const int made = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (made < 0) return false;
  close(made);
  unlink(file.c_str());
  return true;
}

bool canBeOpened(const fs::path& file, const struct stat& info) {
  if (S_ISDIR(info.st_mode)) {
    errno = EISDIR;
    return false;
  }
  // Opening a pipe waits for its reader, and opening a device may act.
  if (!S_ISREG(info.st_mode)) return access(file.c_str(), W_OK) == 0;
  const int opened = open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (opened < 0) return false;
  close(opened);
  return true;
}

}  // namespace

bool isWrittenInPlace(const fs::path& file) {
  if (isStandardOutput(file)) return true;
  const std::optional<struct stat> info = infoOf(file);
  return info && (!S_ISREG(info->st_mode) || isStandardOutputsFile(*info));
}

OpenFile openInPlace(const fs::path& file) {
  const std::optional<struct stat> info = infoOf(file);
  if (!isStandardOutput(file) && !(info && isStandardOutputsFile(*info)))
    return OpenFile(std::fopen(file.c_str(), "wb"));
  std::fflush(stdout);
  const int out = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  return OpenFile(out < 0 ? nullptr : fdopen(out, "wb"));
}

void expectWritable(const fs::path& file, const std::string& what) {
  if (isStandardOutput(file)) return;
  const std::optional<struct stat> info = infoOf(file);
  bool good = false;
  if (info) {
    good = canBeOpened(file, *info);
  } else if (errno == ENOENT && !file.filename().empty()) {
    good = canBeMade(withoutLinks(file));
  } else if (file.filename().empty()) {
    errno = EISDIR;
  }
  if (!good)
    throw ModelError({file.string(), 0}, what,
                     fmt::format("cannot be written: {}", std::strerror(errno)));
}

Descriptor::~Descriptor() {
  if (number_ >= 0) close(number_);
}

OutputFile::OutputFile(const fs::path& file, const std::string& what) : target_(file), what_(what) {
  expectWritable(file, what);
  if (isWrittenInPlace(file)) return;
  target_ = withoutLinks(file);
  removeLeftParts(target_);
  fs::path part;
  const int made = makePart(target_, part);
  if (made < 0)
    throw ModelError(
        {file.string(), 0}, what,
        fmt::format("cannot be written: no file can be made beside it: {}", std::strerror(errno)));
  close(made);
  unlink(part.c_str());
  forgetPart(part);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : target_(std::move(other.target_)),
      part_(std::exchange(other.part_, {})),
      what_(std::move(other.what_)),
      file_(std::move(other.file_)),
      lock_(std::move(other.lock_)),
      error_(other.error_) {}

OutputFile::~OutputFile() {
  file_.reset();
  if (part_.empty()) return;
  unlink(part_.c_str());
  forgetPart(part_);
}

void OutputFile::note(bool done) {
  if (!done && error_ == 0) error_ = errno != 0 ? errno : EIO;
}

void OutputFile::open() {
  if (isWrittenInPlace(target_)) {
    file_ = openInPlace(target_);
  } else {
    const int made = makePart(target_, part_);
    if (made >= 0) file_.reset(fdopen(made, "wb"));
    // The lock outlives the file's closing, until it has its name.
    lock_ = Descriptor(made < 0 ? -1 : fcntl(made, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
  }
  note(file_ != nullptr);
}

void OutputFile::write(std::string_view text) {
  if (!file_ && error_ == 0) open();
  if (error_ == 0) note(std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size());
}

void OutputFile::commit() {
  if (!file_ && error_ == 0) open();
  if (error_ == 0) note(std::fflush(file_.get()) == 0);
  if (file_) note(std::fclose(file_.release()) == 0);
  if (error_ == 0 && !part_.empty()) {
    note(std::rename(part_.c_str(), target_.c_str()) == 0);
    if (error_ == 0) forgetPart(std::exchange(part_, {}));
    lock_ = Descriptor();
  }
  if (error_ != 0) fail();
}

void OutputFile::fail() const {
  throw std::runtime_error(
      fmt::format("{}: {}: cannot be written: {}", target_.string(), what_, std::strerror(error_)));
}

}  // namespace softgauss::io::detail

namespace softgauss::io {

bool isStandardOutput(const std::filesystem::path& file) {
  for (const char* name : {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"})
    if (file == name) return true;
  return false;
}

void expectWritable(const std::filesystem::path& file, const std::string& what) {
  detail::expectWritable(file, what);
}

}  // namespace softgauss::io
