// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/csv.hpp"

namespace softgauss::io::detail {

std::string quotedCsv(const std::string& field) {
  if (field.find_first_of(",\"\r\n") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

const std::vector<std::string>* CsvReader::next() {
  while (!rest_.empty()) {
    readRecord();
    if (fields_.size() > 1 || !fields_.front().empty()) return &fields_;
  }
  return nullptr;
}

void CsvReader::readRecord() {
  line_ = nextLine_;
  fields_.assign(1, {});
  bool quoted = false;
  std::size_t i = 0;
  for (bool atEnd = false; i < rest_.size() && !atEnd; ++i) {
    const char c = rest_[i];
    if (c == '\n') ++nextLine_;
    if (quoted) {
      const bool isEscaped = c == '"' && i + 1 < rest_.size() && rest_[i + 1] == '"';
      if (isEscaped) ++i;
      if (c == '"' && !isEscaped)
        quoted = false;
      else
        fields_.back() += c;
    } else if (c == '"' && fields_.back().empty()) {
      quoted = true;
    } else if (c == ',') {
      fields_.emplace_back();
    } else if (c == '\n') {
      atEnd = true;
    } else if (c != '\r') {
      fields_.back() += c;
    }
  }
  rest_.remove_prefix(i);
  openQuote_ = quoted;
}

}  // namespace softgauss::io::detail
