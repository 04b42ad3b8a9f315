// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/row_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/csv.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 18;

}  // namespace

RowFile::RowFile(const std::filesystem::path& file, std::string what,
                 const std::vector<std::string>& columns, std::optional<std::int64_t> after)
    : path_(file.string()), what_(std::move(what)) {
  buffer_.reserve(2 * kBufferSize);
  for (const std::string& column : columns) add(column);
  endRow();
  if (after && !isWrittenInPlace(file)) {
    goOn(std::exchange(buffer_, {}), *after);
    return;
  }
  if (after) buffer_.clear();  // who reads has the header, and the rows until then
  file_ = openInPlace(file);
  if (!file_ || !send() || std::fflush(file_.get()) != 0) refuse();
}

/// Opens what an earlier process has written, as it was then.
void RowFile::goOn(const std::string& header, std::int64_t after) {
  file_.reset(std::fopen(path_.c_str(), "r+b"));
  if (!file_) refuse();
  std::string found(header.size(), '\0');
  const bool same = std::fread(found.data(), 1, found.size(), file_.get()) == found.size() &&
                    found == header && fseeko(file_.get(), 0, SEEK_END) == 0;
  if (const std::int64_t size = ftello(file_.get()); !same || size < after)
    throw ModelError({path_, 0}, what_,
                     same ? fmt::format("found {} bytes, expected at least the {} that the run had "
                                        "written when its checkpoint was",
                                        size, after)
                          : "found another table, expected the one that the run began");
  if (ftruncate(fileno(file_.get()), after) != 0 || fseeko(file_.get(), after, SEEK_SET) != 0)
    refuse();
}

RowFile::~RowFile() {
  if (file_) send();
}

void RowFile::add(double x) {
  next();
  appendNumber(buffer_, x);
}

void RowFile::add(int x) {
  next();
  fmt::format_to(std::back_inserter(buffer_), "{}", x);
}

void RowFile::add(const std::string& text) {
  next();
  buffer_ += quotedCsv(text);
}

void RowFile::endRow() {
  buffer_ += '\n';
  rowIsEmpty_ = true;
  if (buffer_.size() >= kBufferSize && !send()) failed();
}

void RowFile::flush() {
  if (!send() || std::fflush(file_.get()) != 0) failed();
}

void RowFile::close() {
  if (!file_) return;
  const bool sent = send();
  if (std::fclose(file_.release()) != 0 || !sent) failed();
}

std::int64_t RowFile::end() {
  flush();
  return isWrittenInPlace(path_) ? -1 : ftello(file_.get());
}

bool RowFile::send() noexcept {
  const bool sent = std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) == buffer_.size();
  buffer_.clear();
  return sent;
}

void RowFile::refuse() const {
  throw ModelError({path_, 0}, what_, fmt::format("cannot be written: {}", std::strerror(errno)));
}

void RowFile::failed() const {
  throw std::runtime_error(
      fmt::format("{}: {}: cannot be written: {}", path_, what_, std::strerror(errno)));
}

}  // namespace softgauss::io::detail
