// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/growing_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "softgauss/engine/core/check.hpp"

namespace softgauss::io::detail {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 18;

}  // namespace

GrowingFile::GrowingFile(const std::filesystem::path& file, std::string what,
                         const std::string& beginning, std::optional<std::int64_t> after)
    : path_(file.string()), what_(std::move(what)) {
  buffer_.reserve(2 * kBufferSize);
  if (after && !isWrittenInPlace(file)) {
    goOn(beginning, *after);
    return;
  }
  if (!after) buffer_ = beginning;  // else who reads has it, and all until then
  file_ = openInPlace(file);
  if (!file_ || !send() || std::fflush(file_.get()) != 0) refuse();
}

/// Opens what an earlier process has written, as it was then.
void GrowingFile::goOn(const std::string& beginning, std::int64_t after) {
  file_.reset(std::fopen(path_.c_str(), "r+b"));
  if (!file_) refuse();
  std::string found(beginning.size(), '\0');
  const bool same = std::fread(found.data(), 1, found.size(), file_.get()) == found.size() &&
                    found == beginning && fseeko(file_.get(), 0, SEEK_END) == 0;
  if (const std::int64_t size = ftello(file_.get()); !same || size < after)
    throw ModelError({path_, 0}, what_,
                     same ? fmt::format("found {} bytes, expected at least the {} that the run had "
                                        "written when its checkpoint was",
                                        size, after)
                          : "found another table, expected the one that the run began");
  if (ftruncate(fileno(file_.get()), after) != 0 || fseeko(file_.get(), after, SEEK_SET) != 0)
    refuse();
}

GrowingFile::~GrowingFile() {
  if (file_) send();
}

void GrowingFile::sendIfFull() {
  if (buffer_.size() >= kBufferSize && !send()) failed();
}

void GrowingFile::flush() {
  if (!send() || std::fflush(file_.get()) != 0) failed();
}

void GrowingFile::close() {
  if (!file_) return;
  const bool sent = send();
  if (std::fclose(file_.release()) != 0 || !sent) failed();
}

std::int64_t GrowingFile::end() {
  flush();
  return isWrittenInPlace(path_) ? -1 : ftello(file_.get());
}

bool GrowingFile::send() noexcept {
  const bool sent = std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) == buffer_.size();
  buffer_.clear();
  return sent;
}

void GrowingFile::refuse() const {
  throw ModelError({path_, 0}, what_, fmt::format("cannot be written: {}", std::strerror(errno)));
}

void GrowingFile::failed() const {
  throw std::runtime_error(
      fmt::format("{}: {}: cannot be written: {}", path_, what_, std::strerror(errno)));
}

}  // namespace softgauss::io::detail
