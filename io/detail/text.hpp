// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Strict, locale-free numbers and small helpers for messages.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace softgauss::io::detail {

/// Numbers of files are at most so large: products of a few of them, squared, are still finite.
/// What may not be zero is at least so large.
inline constexpr double kLargestNumber = 1e12, kSmallestNumber = 1e-12;

/// The decimal number that `text` holds, all of it and nothing else but blanks around it; nothing
/// for "1e", "1,5", "0x1", "nan", "inf", an empty text or a number beyond double's range.
std::optional<double> parseNumber(std::string_view text);

/// The parts of a text between blanks.
std::vector<std::string_view> words(std::string_view text);

/// Numbers separated by blanks; nothing if one of them is not a number.
std::optional<std::vector<double>> parseNumbers(std::string_view text);

/// Shortest text that reads back as the same double, bit for bit (at most 17 significant digits).
void appendNumber(std::string& out, double x);

/// A number for messages: six significant digits.
std::string shortNumber(double x);

/// ", did you mean 'x'?" for the nearest of the names, or nothing when none is near.
std::string suggestion(std::string_view name, const std::vector<std::string>& names);

/// What is told beside a name that does not exist: ", did you mean 'x'? there are: x, y, z".
std::string offered(std::string_view name, const std::vector<std::string>& names);

/// "a, b, c and 4 more".
std::string listed(const std::vector<std::string>& names, std::size_t most = 12);

/// "1 joint", "2 joints".
std::string counted(std::size_t n, std::string_view noun);

/// Text as messages show it: in quotes, short, and without characters that move a terminal's
/// cursor.
std::string quotedText(const std::string& text);

/// Where the first byte is that is no UTF-8; std::string::npos where all are.
std::size_t invalidUtf8(std::string_view text);

/// The text with a replacement mark for every byte that is no UTF-8.
std::string validUtf8(const std::string& text);

/// The whole file, or nothing if it cannot be read.
std::optional<std::string> readFile(const std::string& path);

}  // namespace softgauss::io::detail
