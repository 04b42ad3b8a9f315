// SPDX-License-Identifier: Apache-2.0
/// The run that a replay page holds, taken out of it.

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cstring>
#include <optional>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/replay/detail/payload.hpp"
#include "softgauss/io/replay/page.hpp"

namespace softgauss::io {
namespace {

constexpr std::string_view kBegin =
    "<script id=\"softgauss-run\" type=\"application/octet-stream\">";
constexpr std::uintmax_t kLargestPage = std::uintmax_t{1} << 30;

/// RFC 4648; nothing where the text is no base64.
std::optional<std::string> fromBase64(std::string_view text) {
  std::array<int, 256> value;
  value.fill(-1);
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < kDigits.size(); ++i)
    value[static_cast<unsigned char>(kDigits[i])] = static_cast<int>(i);
  if (text.size() % 4 != 0) return std::nullopt;
  for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
  std::string out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : text) {
    const int digit = value[static_cast<unsigned char>(c)];
    if (digit < 0) return std::nullopt;
    word = word << 6 | static_cast<std::uint32_t>(digit);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    out += static_cast<char>(word >> bits & 0xffu);
  }
  return out;
}

/// Inflates all of a zlib stream, whose sum is looked at, and keeps the first bytes; nothing where
/// it is damaged.
std::optional<std::string> startOf(std::string deflated, std::size_t bytes) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::runtime_error("out of memory");
  stream.next_in = reinterpret_cast<Bytef*>(deflated.data());
  stream.avail_in = static_cast<uInt>(deflated.size());
  std::string start, piece(1 << 16, '\0');
  int result = Z_OK;
  while (result == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    result = inflate(&stream, Z_NO_FLUSH);
    if (start.size() < bytes) start.append(piece, 0, piece.size() - stream.avail_out);
  }
  inflateEnd(&stream);
  if (result != Z_STREAM_END || start.size() < bytes) return std::nullopt;
  return start;
}

}  // namespace

std::string runInPage(const std::filesystem::path& file) {
  const std::string name = detail::inputName(file.string());
  const auto fail = [&](const std::string& problem) {
    throw ModelError({name, 0}, "replay page", problem);
  };
  const std::string text =
      detail::readInput(file.string(), "a page that --view has written", kLargestPage);
  const std::size_t at = text.find(kBegin);
  const std::size_t end = at == std::string::npos ? at : text.find('<', at + kBegin.size());
  if (end == std::string::npos) fail("found no run, expected a page that --view has written");
  std::string run = text.substr(at + kBegin.size(), end - at - kBegin.size());
  const std::optional<std::string> deflated = fromBase64(run);
  const std::optional<std::string> start =
      deflated ? startOf(*deflated, detail::kPayloadStart) : std::nullopt;
  if (!start || !start->starts_with(detail::kPayloadMagic))
    fail("found a run that is damaged, expected one as --view has written it");
  std::uint32_t version = 0;
  std::memcpy(&version, start->data() + detail::kPayloadMagic.size(), sizeof version);
  if (version != detail::kPayloadVersion)
    fail(fmt::format("found a run of format {}, expected {}: write its page anew", version,
                     detail::kPayloadVersion));
  return run;
}

}  // namespace softgauss::io
