// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Strict, locale-free numbers and small helpers for messages.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace softgauss::io::detail {

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

/// "a, b, c and 4 more".
std::string listed(const std::vector<std::string>& names, std::size_t most = 12);

/// "1 joint", "2 joints".
std::string counted(std::size_t n, std::string_view noun);

/// The text with a replacement mark for every byte that is no UTF-8.
std::string validUtf8(const std::string& text);

/// The whole file, or nothing if it cannot be read.
std::optional<std::string> readFile(const std::string& path);

}  // namespace softgauss::io::detail
