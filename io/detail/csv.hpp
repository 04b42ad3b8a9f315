// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Fields of comma-separated values (RFC 4180).

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace softgauss::io::detail {

/// The field as written: in quotes where it holds a comma, a quote or a line break.
std::string quotedCsv(const std::string& field);

/// Reads records one after another; quoted fields may hold line breaks.
class CsvReader {
 public:
  /// A byte-order mark, which spreadsheets write first, is no part of the text.
  explicit CsvReader(std::string_view text)
      : rest_(text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text) {}

  /// Fields of the next record that is not empty; nothing at the end of the text.
  const std::vector<std::string>* next();

  int line() const { return line_; }               ///< in which the last record begins
  bool quoteIsOpen() const { return openQuote_; }  ///< the text ended inside quotes

 private:
  static constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

  void readRecord();

  std::string_view rest_;
  std::vector<std::string> fields_;
  int line_ = 0;
  int nextLine_ = 1;
  bool openQuote_ = false;
};

}  // namespace softgauss::io::detail
