// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/row_file.hpp"

#include <fmt/format.h>

#include <utility>

#include "softgauss/io/detail/csv.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

std::string headerOf(const std::vector<std::string>& columns) {
  std::string header;
  for (const std::string& column : columns)
    header += (header.empty() ? "" : ",") + quotedCsv(column);
  return header + '\n';
}

}  // namespace

RowFile::RowFile(const std::filesystem::path& file, std::string what,
                 const std::vector<std::string>& columns, std::optional<std::int64_t> after)
    : file_(file, std::move(what), headerOf(columns), after) {}

void RowFile::add(double x) {
  next();
  appendNumber(file_.buffer(), x);
}

void RowFile::add(int x) {
  next();
  fmt::format_to(std::back_inserter(file_.buffer()), "{}", x);
}

void RowFile::add(const std::string& text) {
  next();
  file_.buffer() += quotedCsv(text);
}

void RowFile::endRow() {
  file_.buffer() += '\n';
  rowIsEmpty_ = true;
  file_.sendIfFull();
}

}  // namespace softgauss::io::detail
