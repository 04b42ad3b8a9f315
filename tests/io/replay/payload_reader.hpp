// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Reads what a replay page holds, as docs/replay_format.md has it.

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace softgauss::test {

inline std::string fromBase64(std::string_view text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0, word = 0;
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<unsigned>(digits.find(c));
    if ((bits += 6) >= 8) out += static_cast<char>(word >> (bits -= 8) & 255u);
  }
  return out;
}

inline std::string inflated(const std::string& packed) {
  z_stream stream = {};
  EXPECT_EQ(inflateInit(&stream), Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string out, piece(1 << 16, '\0');
  int status = Z_OK;
  while (status == Z_OK) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    status = inflate(&stream, Z_NO_FLUSH);
    out.append(piece, 0, piece.size() - stream.avail_out);
  }
  EXPECT_EQ(status, Z_STREAM_END);
  inflateEnd(&stream);
  return out;
}

/// The payload of a page's text.
inline std::string payloadOfPage(const std::string& page) {
  const std::string mark = "<script id=\"softgauss-run\" type=\"application/octet-stream\">";
  const std::size_t found = page.find(mark);
  EXPECT_NE(found, std::string::npos);
  if (found == std::string::npos) return {};
  const std::size_t begin = found + mark.size();
  return inflated(fromBase64(std::string_view(page).substr(begin, page.find('<', begin) - begin)));
}

/// The header and the arrays of a payload, read as docs/replay_format.md has it.
class PayloadReader {
 public:
  explicit PayloadReader(std::string bytes) : bytes_(std::move(bytes)) {
    EXPECT_EQ(bytes_.substr(0, 8), "SGREPLAY");
    std::uint32_t words[2];
    std::memcpy(words, bytes_.data() + 8, sizeof words);
    EXPECT_EQ(words[0], 1u);
    EXPECT_EQ(words[1] % 8, 0u);
    header = nlohmann::json::parse(bytes_.substr(16, words[1]));
    start_ = 16 + words[1];
  }

  template <class T>
  std::vector<T> array(const std::string& name) const {
    const nlohmann::json& entry = header.at("arrays").at(name);
    const std::size_t offset = entry.at("offset"), length = entry.at("length");
    EXPECT_EQ(offset % 8, 0u);
    EXPECT_LE(start_ + offset + length * sizeof(T), bytes_.size());
    std::vector<T> values(length);
    std::memcpy(values.data(), bytes_.data() + start_ + offset, length * sizeof(T));
    return values;
  }

  nlohmann::json header;

 private:
  std::string bytes_;
  std::size_t start_ = 0;
};

}  // namespace softgauss::test
