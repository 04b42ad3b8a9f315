// SPDX-License-Identifier: Apache-2.0
/// Landscapes of .png and .csv files.
#include "softgauss/io/height_field.hpp"

#include <zlib.h>

#include <cmath>

#include "scene_folder.hpp"
#include "softgauss/engine/model/closed_surface.hpp"
#include "softgauss/engine/model/mass_properties.hpp"

namespace softgauss::test {
namespace {

std::string bigEndian(std::uint32_t x) {
  return {static_cast<char>(x >> 24), static_cast<char>(x >> 16), static_cast<char>(x >> 8),
          static_cast<char>(x)};
}

std::string chunk(const std::string& type, const std::string& data) {
  const std::string checked = type + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return bigEndian(static_cast<std::uint32_t>(data.size())) + checked +
         bigEndian(static_cast<std::uint32_t>(sum));
}

struct Png {
  std::uint32_t width = 3, height = 5;
  int bits = 8, colour = 0, interlaced = 0;

  int level(std::uint32_t x, std::uint32_t y) const {
    return static_cast<int>((7919 * (x + 10 * y) + 31 * x * y) % (1u << bits));
  }
  /// Of a pixel: grey, or red with green and blue, and with transparency.
  std::size_t channels() const { return colour == 2 ? 3 : colour == 4 ? 2 : colour == 6 ? 4 : 1; }
  /// Row y is written with filter y mod 5; levels beside the first are of no meaning.
  std::string text() const {
    const std::size_t bytes = static_cast<std::size_t>(bits / 8), step = bytes * channels(),
                      row = width * step;
    std::string pixels(height * row, '\0'), raw;
    for (std::uint32_t y = 0; y < height; ++y)
      for (std::uint32_t x = 0; x < width; ++x)
        for (std::size_t b = 0; b < step; ++b)
          pixels[y * row + x * step + b] =
              b < bytes ? static_cast<char>(level(x, y) >> (8 * (bytes - 1 - b)) & 255)
                        : static_cast<char>(37 * x + 11 * b);
    for (std::size_t y = 0; y < height; ++y) {
      raw += static_cast<char>(y % 5);
      for (std::size_t i = 0; i < row; ++i) {
        const auto at = [&](std::size_t dx, std::size_t dy) {
          return i < dx || y < dy ? 0
                                  : static_cast<int>(static_cast<unsigned char>(
                                        pixels[(y - dy) * row + i - dx]));
        };
        const int a = at(step, 0), b = at(0, 1), c = at(step, 1), p = a + b - c;
        const int paeth = std::abs(p - a) <= std::min(std::abs(p - b), std::abs(p - c)) ? a
                          : std::abs(p - b) <= std::abs(p - c)                          ? b
                                                                                        : c;
        const int predicted[] = {0, a, b, (a + b) / 2, paeth};
        raw += static_cast<char>(pixels[y * row + i] - predicted[y % 5]);
      }
    }
    auto size = compressBound(static_cast<uLong>(raw.size()));
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size,
             reinterpret_cast<const Bytef*>(raw.data()), static_cast<uLong>(raw.size()));
    packed.resize(size);
    std::string header = bigEndian(width) + bigEndian(height);
    for (const int x : {bits, colour, 0, 0, interlaced}) header += static_cast<char>(x);
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + chunk("tEXt", "a comment") +
           chunk("IDAT", packed.substr(0, 5)) + chunk("IDAT", packed.substr(5)) + chunk("IEND", "");
  }
};

std::string refusalOf(const std::string& name, const std::string& text) {
  const io::TempFolder folder;
  try {
    io::readHeights(folder.write(name, text));
  } catch (const ModelError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Heights, ArePixelsOfAnImage) {
  const io::TempFolder folder;
  for (const auto& [bits, colour] : {std::pair(8, 0), {16, 0}, {8, 2}, {16, 4}, {8, 6}, {16, 6}}) {
    Png png;
    png.bits = bits;
    png.colour = colour;
    const io::Heights heights = io::readHeights(
        folder.write("h.PNG", png.text()), colour == 0 ? io::PngLevels::grey : io::PngLevels::red);
    ASSERT_EQ(heights.columns, 3);
    ASSERT_EQ(heights.rows, 5);
    for (std::uint32_t y = 0; y < 5; ++y)
      for (std::uint32_t x = 0; x < 3; ++x)
        EXPECT_EQ(heights.values[3 * y + x], png.level(x, y) / (std::ldexp(1.0, bits) - 1.0));
  }
}

TEST(Heights, AreNumbersOfATable) {
  const io::TempFolder folder;
  const io::Heights heights = io::readHeights(folder.write("h.csv", "0, 1.5,-2\r\n3e-1,4,5\n\n"));
  EXPECT_EQ(heights.columns, 3);
  EXPECT_EQ(heights.rows, 2);
  EXPECT_EQ(heights.values, (std::vector<double>{0, 1.5, -2, 0.3, 4, 5}));
}

TEST(Heights, RefuseWhatIsNone) {
  const auto says = [](const std::string& name, const std::string& text, const std::string& words) {
    const std::string message = refusalOf(name, text);
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_NE(message.find(name), std::string::npos) << message;
  };
  says("h.csv", "1,2\n3,4,5\n", "h.csv:2: heights: found 3 values, expected 2");
  says("h.csv", "1,2\n3,x\n", "h.csv:2: heights: found 'x', expected a number");
  says("h.csv", "1,2\n3,nan\n", "expected a number");
  says("h.csv", "1,2\n", "found 1 by 2 values, expected at least 2 by 2");
  says("h.csv", "", "expected at least 2 by 2");
  says("h.tif", "1,2\n3,4\n", "unknown format '.tif', expected .png or .csv");

  const auto refuses = [&](const Png& png, const std::string& words) {
    says("h.png", png.text(), words);
  };
  refuses({3, 5, 8, 2, 0}, "has colours");
  refuses({3, 5, 8, 0, 1}, "is interlaced");
  refuses({3, 1, 8, 0, 0}, "expected at least 2 by 2");
  says("h.png", "1,2\n3,4\n", "is no PNG image");
  const std::string good = Png().text();
  for (const std::size_t size : {std::size_t{8}, std::size_t{20}, good.size() / 2, good.size() - 1})
    says("h.png", good.substr(0, size), "ends too early");
  for (std::size_t i = 16; i < good.size(); i += 3) {
    std::string damaged = good;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x11);
    EXPECT_NE(refusalOf("h.png", damaged), "no error") << i;
  }
}

// 3 by 2 values over 2 m by 1 m: a solid with the first row at +y.
TEST(HeightField, IsASolidUnderItsSurface) {
  const io::Heights heights{2, 3, {1, 1, 1, 2, 2, 2}};
  const Mesh mesh = io::heightFieldMesh(heights, 2.0, 1.0, 0.5, 0.25);
  EXPECT_FALSE(surfaceDefects(mesh).any());
  for (const Vector3& v : mesh.vertices) {
    const bool isTop = v.z() > 0.3;
    if (isTop) {
      EXPECT_DOUBLE_EQ(v.z(), v.y() > 0.0 ? 0.5 : 1.0);
    } else {
      EXPECT_DOUBLE_EQ(v.z(), 0.25);
    }
  }
  // A prism: the mean height of the surface above the bottom is 0.5 m.
  const Shape solid = Shape::hull(std::make_shared<const Mesh>(mesh));
  EXPECT_NEAR(solidOf(solid, 1.0).mass, 2.0 * 1.0 * 0.5, 1e-12);
}

io::SceneFile landscape(const std::string& keys) {
  const io::TempFolder folder;
  folder.write("h.csv", "0,1,2\n0,1,2\n");
  return io::readScene(
      folder.write("s.yaml", "objects: [{name: hill, heights: {file: h.csv, " + keys + "}]\n"));
}

TEST(HeightField, IsAFixedShapeOfAScene) {
  const Model model = landscape("size: [4, 2], height: 0.5}").builder.build();
  ASSERT_EQ(model.geometries.size(), 1u);
  const Geometry& g = model.geometries[0];
  EXPECT_EQ(g.shape.kind, ShapeKind::triangles);
  EXPECT_EQ(g.body, 0);
  EXPECT_FALSE(g.automaticMesh);
  double highest = -1.0, lowest = 1.0;
  for (const Vector3& v : g.shape.mesh->vertices) {
    highest = std::max(highest, v.z());
    lowest = std::min(lowest, v.z());
  }
  EXPECT_EQ(highest, 1.0);
  EXPECT_EQ(lowest, -1.0) << "half the shorter side below the lowest";
}

TEST(HeightField, RefusesWhatItCannotUse) {
  const auto says = [](const std::string& keys, const std::string& words) {
    std::string message = "no error";
    try {
      landscape(keys);
    } catch (const ModelError& error) {
      message = error.what();
    }
    EXPECT_NE(message.find(words), std::string::npos) << keys << ": " << message;
  };
  says("size: [4], height: 1}", "expected two lengths above 0");
  says("size: [4, -2], height: 1}", "expected two lengths above 0");
  says("size: [4, 2]}", "'heights.height'");
  says("height: 1}", "'heights.size'");
  says("size: [4, 2], height: 1, base: 0}", "'heights.base'");
  says("size: [4, 2], height: 1}, fixed: false", "a landscape that moves");
  says("size: [4, 2], height: 1}, mass: 3", "fixed to the world");
  says("size: [4, 2], height: 1}, collide_as: hull", "is for a mesh");
}

}  // namespace
}  // namespace softgauss::test
