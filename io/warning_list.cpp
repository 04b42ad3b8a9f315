// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/warning_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "softgauss/io/detail/text.hpp"

namespace softgauss::io {
namespace {

constexpr std::size_t kMostNames = 8;

/// A warning as its kind, its names and all.
struct Parsed {
  std::string kind;  ///< without names and numbers
  std::vector<std::string> names;

  explicit Parsed(const std::string& text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
      const std::size_t end = opensName(text, i) ? text.find('\'', i + 1) : std::string::npos;
      if (end != std::string::npos) {
        names.push_back(text.substr(i + 1, end - i - 1));
        kind += "''";
        i = end;
      } else if (isDigit(text[i])) {
        if (kind.empty() || kind.back() != '#') kind += '#';
        while (i + 1 < text.size() && isOfNumber(text, i + 1)) ++i;
      } else {
        kind += text[i];
      }
    }
  }

 private:
  /// A quote, not an apostrophe.
  static bool opensName(const std::string& text, std::size_t i) {
    return text[i] == '\'' && (i == 0 || !std::isalnum(static_cast<unsigned char>(text[i - 1])));
  }
  static bool isDigit(char c) { return c >= '0' && c <= '9'; }
  /// Digits, and a point, an exponent or its sign between digits.
  static bool isOfNumber(const std::string& text, std::size_t i) {
    if (isDigit(text[i])) return true;
    if (i + 1 >= text.size()) return false;
    const bool signOfExponent = (text[i] == '-' || text[i] == '+') && text[i - 1] == 'e';
    return ((text[i] == '.' || signOfExponent) && isDigit(text[i + 1])) ||
           (text[i] == 'e' && (isDigit(text[i + 1]) || text[i + 1] == '-' || text[i + 1] == '+'));
  }
};

}  // namespace

std::vector<std::string> grouped(const std::vector<std::string>& warnings) {
  std::vector<std::vector<Parsed>> kinds;
  std::vector<std::string> lines;
  std::map<std::string, std::size_t> known;
  for (const std::string& warning : warnings) {
    Parsed parsed(warning);
    const auto [place, isNew] = known.try_emplace(parsed.kind, kinds.size());
    if (isNew) {
      kinds.emplace_back();
      lines.push_back(warning);
    }
    kinds[place->second].push_back(std::move(parsed));
  }
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const std::vector<Parsed>& kind = kinds[k];
    if (kind.size() == 1) continue;
    // The first name that is not the same in all tells them apart.
    std::vector<std::string> others;
    for (std::size_t n = 0; n < kind[0].names.size() && others.empty(); ++n)
      for (const Parsed& other : kind)
        if (other.names[n] != kind[0].names[n] &&
            std::find(others.begin(), others.end(), "'" + other.names[n] + "'") == others.end())
          others.push_back("'" + other.names[n] + "'");
    lines[k] += others.empty() ? fmt::format("; {} more of this kind", kind.size() - 1)
                               : "; the same of " + detail::listed(others, kMostNames);
  }
  return lines;
}

}  // namespace softgauss::io
