// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/height_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/io/detail/csv.hpp"
#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/png.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io {
namespace {

constexpr std::size_t kMostValues = 4'000'000;

Heights fromCsv(const std::string& file, const std::string& text) {
  Heights heights;
  detail::CsvReader reader(text);
  while (const std::vector<std::string>* fields = reader.next()) {
    const auto fail = [&](const std::string& problem) {
      throw ModelError({file, reader.line()}, "heights", problem);
    };
    const auto columns = static_cast<int>(fields->size());
    if (heights.rows++ == 0) heights.columns = columns;
    if (columns != heights.columns)
      fail(fmt::format("found {}, expected {} as in the first line",
                       detail::counted(fields->size(), "value"), heights.columns));
    for (const std::string& field : *fields) {
      const std::optional<double> value = detail::parseNumber(field);
      if (!value || std::abs(*value) > detail::kLargestNumber)
        fail(
            fmt::format("found {}, expected a number{}", detail::quotedText(field),
                        value ? fmt::format(" of size {:g} at most", detail::kLargestNumber) : ""));
      heights.values.push_back(*value);
    }
    if (heights.values.size() > kMostValues)
      fail(fmt::format("found more than {} values, expected fewer", kMostValues));
  }
  if (reader.quoteIsOpen())
    throw ModelError({file, reader.line()}, "heights", "a quote is not closed");
  return heights;
}

Heights fromPng(const std::string& file, const std::string& bytes, PngLevels levels) {
  detail::GreyImage image = detail::readGreyPng(file, bytes, levels == PngLevels::red);
  return {image.height, image.width, std::move(image.levels)};
}

}  // namespace

Heights readHeights(const std::filesystem::path& file, PngLevels levels) {
  const auto fail = [&](const std::string& problem) {
    throw ModelError({file.string(), 0}, "heights", problem);
  };
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (extension != ".png" && extension != ".csv")
    fail(fmt::format("unknown format '{}', expected .png or .csv", extension));
  const std::string bytes = detail::readInput(file.string(), "a .png or .csv file");
  Heights heights =
      extension == ".png" ? fromPng(file.string(), bytes, levels) : fromCsv(file.string(), bytes);
  if (heights.rows < 2 || heights.columns < 2)
    fail(fmt::format("found {} by {} values, expected at least 2 by 2", heights.rows,
                     heights.columns));
  if (heights.values.size() > kMostValues)
    fail(fmt::format("found {} values, expected at most {}", heights.values.size(), kMostValues));
  return heights;
}

Mesh heightFieldMesh(const Heights& h, double x, double y, double scale, double base) {
  Mesh mesh;
  mesh.vertices.reserve(h.values.size() + 2 * idx(h.rows + h.columns));
  const auto vertex = [&](int row, int column) { return row * h.columns + column; };
  double lowest = kInfinity;
  for (int row = 0; row < h.rows; ++row)
    for (int column = 0; column < h.columns; ++column) {
      const double z = scale * h.values[idx(vertex(row, column))];
      lowest = std::min(lowest, z);
      mesh.vertices.emplace_back(x * (column / (h.columns - 1.0) - 0.5),
                                 y * (0.5 - row / (h.rows - 1.0)), z);
    }
  mesh.triangles.reserve(2 * h.values.size());
  for (int row = 0; row + 1 < h.rows; ++row)
    for (int column = 0; column + 1 < h.columns; ++column) {
      const int a = vertex(row, column), b = vertex(row, column + 1), c = vertex(row + 1, column),
                d = vertex(row + 1, column + 1);
      mesh.triangles.push_back({a, c, d});
      mesh.triangles.push_back({a, d, b});
    }

  // The rim, counter-clockwise seen from above, and the same on the bottom.
  std::vector<int> rim;
  for (int column = 0; column + 1 < h.columns; ++column) rim.push_back(vertex(h.rows - 1, column));
  for (int row = h.rows - 1; row > 0; --row) rim.push_back(vertex(row, h.columns - 1));
  for (int column = h.columns - 1; column > 0; --column) rim.push_back(vertex(0, column));
  for (int row = 0; row + 1 < h.rows; ++row) rim.push_back(vertex(row, 0));
  const auto count = static_cast<int>(rim.size());
  const auto firstBelow = static_cast<int>(mesh.vertices.size());
  for (const int v : rim) {
    const Vector3& top = mesh.vertices[idx(v)];
    mesh.vertices.emplace_back(top.x(), top.y(), lowest - base);
  }
  const auto middle = static_cast<int>(mesh.vertices.size());
  mesh.vertices.emplace_back(0.0, 0.0, lowest - base);
  for (int i = 0; i < count; ++i) {
    const int p = rim[idx(i)], q = rim[idx((i + 1) % count)];
    const int below = firstBelow + i, next = firstBelow + (i + 1) % count;
    mesh.triangles.push_back({p, below, q});
    mesh.triangles.push_back({q, below, next});
    mesh.triangles.push_back({middle, next, below});
  }
  return mesh;
}

}  // namespace softgauss::io
