// SPDX-License-Identifier: Apache-2.0
#include "io/detail/output_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "engine/core/check.hpp"

namespace softgauss::io::detail {

OutputFile::OutputFile(const std::filesystem::path& file, const std::string& what)
    : target_(file), written_(file), what_(what) {
  std::error_code error;
  const bool isSpecial =
      std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error);
  if (!isSpecial) written_ += ".part";
  file_.reset(std::fopen(written_.c_str(), "wb"));
  if (!file_)
    throw ModelError({target_.string(), 0}, what,
                     fmt::format("cannot be written: {}", std::strerror(errno)));
}

OutputFile::~OutputFile() {
  if (!file_) return;
  file_.reset();
  std::error_code ignored;
  if (written_ != target_) std::filesystem::remove(written_, ignored);
}

void OutputFile::write(std::string_view text) {
  good_ = good_ && std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size();
}

void OutputFile::commit() {
  good_ = std::fflush(file_.get()) == 0 && good_;
  if (!good_) fail();
  file_.reset();
  if (written_ == target_) return;
  std::error_code error;
  std::filesystem::rename(written_, target_, error);
  if (!error) return;
  errno = error.value();
  fail();
}

void OutputFile::fail() const {
  throw std::runtime_error(
      fmt::format("{}: {}: cannot be written: {}", target_.string(), what_, std::strerror(errno)));
}

}  // namespace softgauss::io::detail
