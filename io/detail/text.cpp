// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>

#include "softgauss/io/printable.hpp"

namespace softgauss::io::detail {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

/// Bytes of the character of UTF-8 that begins at `i`; 0 where none does. Forms that are too long,
/// surrogates and what lies beyond Unicode are none.
std::size_t characterAt(std::string_view text, std::size_t i) {
  const auto byte = [&](std::size_t k) {
    return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u;
  };
  const unsigned first = byte(i), second = byte(i + 1);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4) return 0;
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
      (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F))
    return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte(i + k) & 0xC0u) != 0x80) return 0;
  return length;
}

/// The text up to the end of a character, at most `most` bytes, and a mark that more follows.
std::string cut(std::string_view text, std::size_t most) {
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0u) == 0x80) --most;
  return std::string(text.substr(0, most)) + "…";
}

/// Levenshtein distance.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

std::optional<double> parseNumber(std::string_view text) {
  text = trimmed(text);
  // from_chars takes no leading plus; "+-1" stays an error.
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double x = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(x))
    return std::nullopt;
  return x;
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> parts;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    parts.push_back(text.substr(0, text.find_first_of(kBlanks)));
    text.remove_prefix(parts.back().size());
  }
  return parts;
}

std::optional<std::vector<double>> parseNumbers(std::string_view text) {
  std::vector<double> numbers;
  for (const std::string_view word : words(text)) {
    const std::optional<double> x = parseNumber(word);
    if (!x) return std::nullopt;
    numbers.push_back(*x);
  }
  return numbers;
}

void appendNumber(std::string& out, double x) {
  char text[32];
  out.append(text, std::to_chars(text, text + sizeof text, x).ptr);
}

std::string shortNumber(double x) { return fmt::format("{:.6g}", x); }

std::string suggestion(std::string_view name, const std::vector<std::string>& names) {
  constexpr std::size_t kLongest = 100;  // nobody has mistyped more
  if (name.size() > kLongest) return {};
  const std::string* nearest = nullptr;
  std::size_t best = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : names) {
    if (candidate.size() >= name.size() + best || name.size() >= candidate.size() + best) continue;
    const std::size_t distance = editDistance(name, candidate);
    if (distance >= best) continue;
    best = distance;
    nearest = &candidate;
  }
  return nearest ? fmt::format(", did you mean '{}'?", *nearest) : std::string();
}

std::string listed(const std::vector<std::string>& names, std::size_t most) {
  const std::size_t shown = names.size() > most + 1 ? most : names.size();
  std::string text = fmt::format(
      "{}", fmt::join(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(shown), ", "));
  if (shown < names.size()) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

std::string offered(std::string_view name, const std::vector<std::string>& names) {
  if (names.empty()) return "; there is none";
  const std::string near = suggestion(name, names);
  return fmt::format("{} there are: {}", near.empty() ? ";" : near, listed(names, 20));
}

std::string counted(std::size_t n, std::string_view noun) {
  return fmt::format("{} {}{}", n, noun, n == 1 ? "" : noun.ends_with("ch") ? "es" : "s");
}

std::string quotedText(const std::string& text) {
  constexpr std::size_t kMost = 60;
  // A few bytes more than are shown: an end within a character is no fault of the text.
  std::string shown = validUtf8(text.size() > kMost ? cut(text, kMost) : text);
  std::replace_if(
      shown.begin(), shown.end(),
      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return "'" + shown + "'";
}

std::size_t invalidUtf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = characterAt(text, i);
    if (length == 0) return i;
    i += length;
  }
  return std::string::npos;
}

std::string validUtf8(const std::string& text) {
  std::string valid;
  valid.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = characterAt(text, i);
    if (length > 0)
      valid.append(text, i, length);
    else
      valid += "\uFFFD";
    i += std::max<std::size_t>(length, 1);
  }
  return valid;
}

}  // namespace softgauss::io::detail

namespace softgauss::io {

std::string printable(const std::string& text) {
  constexpr std::size_t kLongestWord = 200, kShownOfIt = 80, kLongest = 6000;
  const std::string valid = detail::validUtf8(text);
  std::string shown;
  for (std::size_t begin = 0; begin < valid.size();) {
    std::size_t end = valid.find_first_of(" \n", begin);
    end = end == std::string::npos ? valid.size() : end;
    const std::string_view word = std::string_view(valid).substr(begin, end - begin);
    shown += word.size() > kLongestWord && word.front() != '/' ? detail::cut(word, kShownOfIt)
                                                               : std::string(word);
    if (end < valid.size()) shown += valid[end];
    begin = end + 1;
  }
  if (shown.size() > kLongest) shown = detail::cut(shown, kLongest);
  std::replace_if(
      shown.begin(), shown.end(),
      [](char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7f; }, '?');
  return shown;
}

}  // namespace softgauss::io

namespace softgauss::io::detail {

std::optional<std::string> readFile(const std::string& path) {
  struct stat info = {};
  if (stat(path.c_str(), &info) != 0 || S_ISDIR(info.st_mode)) return std::nullopt;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) return std::nullopt;
  std::string text;
  char buffer[1 << 16];
  while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, file.get()))
    text.append(buffer, n);
  if (std::ferror(file.get())) return std::nullopt;
  return text;
}

}  // namespace softgauss::io::detail
