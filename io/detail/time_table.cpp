// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/time_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {

void TimeTable::fail(int line, const std::string& element, const std::string& problem) const {
  throw ModelError({name_, line}, element, problem);
}

TimeTable::TimeTable(const std::filesystem::path& file, const std::string& expected)
    : name_(inputName(file.string())),
      text_(readInput(file.string(), "CSV with " + expected)),
      reader_(text_) {
  if (const std::size_t bad = invalidUtf8(text_); bad != std::string::npos)
    fail(1 + static_cast<int>(
                 std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(bad), '\n')),
         "file", "holds a byte that is no UTF-8, expected text in UTF-8");
  const std::vector<std::string>* fields = reader_.next();
  if (!fields) fail(1, "header", "is missing, expected " + expected);
  header_ = *fields;
  std::set<std::string> names;
  for (const std::string& name : header_)
    if (!names.insert(name).second) fail("column " + quotedText(name), "is there twice");
  const std::optional<std::size_t> time = find("time_s");
  if (!time) fail("header", "has no column time_s");
  timeColumn_ = *time;
}

std::optional<std::size_t> TimeTable::find(const std::string& column) const {
  const auto found = std::find(header_.begin(), header_.end(), column);
  if (found == header_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header_.begin());
}

bool TimeTable::next() {
  row_ = reader_.next();
  if (!row_) {
    if (reader_.quoteIsOpen()) fail("row", "a quote is not closed");
    if (!last_) fail("file", "has no row below the header");
    return false;
  }
  if (row_->size() != header_.size())
    fail("row",
         fmt::format("has {} fields, expected {} as the header", row_->size(), header_.size()));
  time_ = number(timeColumn_);
  if (last_ && time_ <= *last_)
    fail("column 'time_s'", fmt::format("{} follows {}, expected rising times", time_, *last_));
  last_ = time_;
  return true;
}

double TimeTable::number(std::size_t column) const {
  const std::string& field = (*row_)[column];
  const std::optional<double> x = parseNumber(field);
  if (!x || std::abs(*x) > kLargestNumber)
    fail("column " + quotedText(header_[column]),
         fmt::format("{} is not a finite number{}", quotedText(field),
                     x ? fmt::format(" of size {:g} at most", kLargestNumber) : ""));
  return *x;
}

}  // namespace softgauss::io::detail
