// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/png.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "softgauss/engine/core/check.hpp"

namespace softgauss::io::detail {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A wider image is no landscape, and would not fit into memory.
constexpr std::uint32_t kMostPixels = 16384;

struct Header {
  std::uint32_t width = 0, height = 0;
  int bytesPerPixel = 1;
  int bytesPerLevel = 1;
};

class PngReader {
 public:
  PngReader(const std::string& file, std::string_view bytes, bool redOfColours)
      : file_(file), rest_(bytes), redOfColours_(redOfColours) {}

  GreyImage read() {
    constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
    if (!rest_.starts_with(kSignature)) fail("is no PNG image");
    rest_.remove_prefix(kSignature.size());
    Header header;
    std::string compressed;
    for (bool isLast = false; !isLast;) {
      const auto [type, data] = nextChunk();
      if (type == "IHDR") header = headerOf(data);
      if (type == "IDAT") compressed += data;
      isLast = type == "IEND";
    }
    if (header.width == 0) fail("has no header");
    return greyOf(header, unfiltered(header, inflated(header, compressed)));
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw ModelError({file_, 0}, "image", problem + ", expected a grey PNG of 8 or 16 bits");
  }

  static std::uint32_t number(std::string_view bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[i]);
    return value;
  }

  std::pair<std::string_view, std::string_view> nextChunk() {
    if (rest_.size() < 12) fail("ends too early");
    const std::size_t size = number(rest_);
    if (rest_.size() - 12 < size) fail("ends too early");
    const std::string_view type = rest_.substr(4, 4), data = rest_.substr(8, size);
    const std::string_view checked = rest_.substr(4, size + 4);
    const auto sum =
        crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
    if (sum != number(rest_.substr(8 + size))) fail("is damaged: a checksum differs");
    rest_.remove_prefix(12 + size);
    return {type, data};
  }

  /// Levels of a pixel by its colour type: grey, red with green and blue, and with transparency; 0
  /// of a palette.
  static int channelsOf(char type) {
    return type == 0 ? 1 : type == 2 ? 3 : type == 4 ? 2 : type == 6 ? 4 : 0;
  }

  Header headerOf(std::string_view data) const {
    if (data.size() != 13) fail("has a header of unknown size");
    Header header{number(data), number(data.substr(4))};
    if (header.width == 0 || header.height == 0 || header.width > kMostPixels ||
        header.height > kMostPixels)
      fail(fmt::format("has {} by {} pixels, at most {} a side can be read", header.width,
                       header.height, kMostPixels));
    const int channels = channelsOf(data[9]);
    if (channels == 0 || (channels > 1 && !redOfColours_)) fail("has colours or transparency");
    if (data[8] != 8 && data[8] != 16) fail(fmt::format("has {} bits a pixel", int{data[8]}));
    header.bytesPerLevel = data[8] / 8;
    header.bytesPerPixel = channels * header.bytesPerLevel;
    if (data[12] != 0) fail("is interlaced");
    return header;
  }

  Bytes inflated(const Header& h, const std::string& compressed) const {
    Bytes raw(h.height * (std::size_t{h.width} * static_cast<std::size_t>(h.bytesPerPixel) + 1));
    auto size = static_cast<uLongf>(raw.size());
    if (uncompress(raw.data(), &size, reinterpret_cast<const Bytef*>(compressed.data()),
                   static_cast<uLong>(compressed.size())) != Z_OK ||
        size != raw.size())
      fail("is damaged: its pixels cannot be unpacked");
    return raw;
  }

  /// Each row was written as differences from its neighbours, in one of five ways.
  Bytes unfiltered(const Header& h, const Bytes& raw) const {
    const auto step = static_cast<std::size_t>(h.bytesPerPixel);
    const std::size_t row = h.width * step;
    Bytes pixels(h.height * row, 0);
    for (std::size_t y = 0; y < h.height; ++y) {
      const std::uint8_t filter = raw[y * (row + 1)];
      if (filter > 4) fail("is damaged: an unknown filter");
      for (std::size_t x = 0; x < row; ++x) {
        const auto at = [&](std::size_t dx, std::size_t dy) {
          return x < dx || y < dy ? 0 : int{pixels[(y - dy) * row + x - dx]};
        };
        const int left = at(step, 0), above = at(0, 1), corner = at(step, 1);
        int predicted = 0;
        if (filter == 1) predicted = left;
        if (filter == 2) predicted = above;
        if (filter == 3) predicted = (left + above) / 2;
        if (filter == 4) predicted = nearestTo(left + above - corner, left, above, corner);
        pixels[y * row + x] = static_cast<std::uint8_t>(raw[y * (row + 1) + 1 + x] + predicted);
      }
    }
    return pixels;
  }

  /// Paeth's predictor: of three the one nearest to p, the first of equals.
  static int nearestTo(int p, int a, int b, int c) {
    const int toA = std::abs(p - a), toB = std::abs(p - b), toC = std::abs(p - c);
    return toA <= toB && toA <= toC ? a : toB <= toC ? b : c;
  }

  static GreyImage greyOf(const Header& h, const Bytes& pixels) {
    GreyImage image{static_cast<int>(h.width), static_cast<int>(h.height), {}};
    image.levels.reserve(std::size_t{h.width} * h.height);
    for (std::size_t i = 0; i < pixels.size(); i += static_cast<std::size_t>(h.bytesPerPixel))
      image.levels.push_back(h.bytesPerLevel == 1 ? pixels[i] / 255.0
                                                  : (256 * pixels[i] + pixels[i + 1]) / 65535.0);
    return image;
  }

  const std::string& file_;
  std::string_view rest_;
  bool redOfColours_;
};

}  // namespace

GreyImage readGreyPng(const std::string& file, const std::string& bytes, bool redOfColours) {
  return PngReader(file, bytes, redOfColours).read();
}

}  // namespace softgauss::io::detail
