// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Plain text in columns.

#include <string>
#include <utility>
#include <vector>

namespace softgauss::io::detail {

/// Lines of cells, each column as wide as its widest cell.
class TextTable {
 public:
  void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  std::string text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace softgauss::io::detail
