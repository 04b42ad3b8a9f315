// SPDX-License-Identifier: Apache-2.0
#include "io/detail/row_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "engine/core/check.hpp"
#include "io/detail/csv.hpp"
#include "io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 18;

}  // namespace

RowFile::RowFile(const std::filesystem::path& file, std::string what,
                 const std::vector<std::string>& columns)
    : path_(file.string()), what_(std::move(what)), file_(openInPlace(file)) {
  const auto refuse = [&] {
    throw ModelError({path_, 0}, what_, fmt::format("cannot be written: {}", std::strerror(errno)));
  };
  if (!file_) refuse();
  buffer_.reserve(2 * kBufferSize);
  for (const std::string& column : columns) add(column);
  endRow();
  if (!send() || std::fflush(file_.get()) != 0) refuse();
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

bool RowFile::send() noexcept {
  const bool sent = std::fwrite(buffer_.data(), 1, buffer_.size(), file_.get()) == buffer_.size();
  buffer_.clear();
  return sent;
}

void RowFile::failed() const {
  throw std::runtime_error(
      fmt::format("{}: {}: cannot be written: {}", path_, what_, std::strerror(errno)));
}

}  // namespace softgauss::io::detail
