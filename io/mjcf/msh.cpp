// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/msh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::mjcf {
namespace {

class MshReader {
 public:
  MshReader(const std::filesystem::path& file, std::uintmax_t largest)
      : file_(file.string()), bytes_(detail::readInput(file_, "an MSH mesh", largest)) {}

  Mesh read() {
    constexpr std::size_t kHeader = 16;
    if (bytes_.size() < kHeader) fail(fmt::format("has {} bytes", bytes_.size()));
    const std::uint64_t vertices = next(), normals = next(), coordinates = next(), faces = next();
    for (const std::uint64_t count : {normals, coordinates})
      if (count != 0 && count != vertices)
        fail(fmt::format("has {} normals or texture coordinates for {} vertices", count, vertices));
    const std::uint64_t size =
        kHeader + 4 * (3 * vertices + 3 * normals + 2 * coordinates + 3 * faces);
    if (vertices < 4 || faces == 0 || size != bytes_.size())
      fail(
          fmt::format("has {} bytes for {} vertices and {} faces", bytes_.size(), vertices, faces));
    Mesh mesh;
    mesh.file = file_;
    mesh.vertices.resize(vertices);
    for (Vector3& vertex : mesh.vertices)
      for (double& x : vertex) x = coordinate();
    at_ += 4 * (3 * normals + 2 * coordinates);
    mesh.triangles.resize(faces);
    for (std::array<int, 3>& triangle : mesh.triangles)
      for (int& corner : triangle) corner = vertexOf(vertices);
    return mesh;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw ModelError({file_, 0}, "mesh",
                     problem +
                         ", expected an MSH: four counts, vertices, normals and texture "
                         "coordinates (none, or one a vertex), and faces");
  }

  std::uint32_t next() {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value |= std::uint32_t{static_cast<std::uint8_t>(bytes_[at_ + i])} << (8 * i);
    at_ += 4;
    return value;
  }

  double coordinate() {
    const double x = std::bit_cast<float>(next());
    if (!(std::abs(x) <= detail::kLargestNumber))
      fail(fmt::format("has a coordinate of {:g} m, more than {:g}", x, detail::kLargestNumber));
    return x;
  }

  int vertexOf(std::uint64_t vertices) {
    const std::uint32_t index = next();
    if (index >= vertices)
      fail(fmt::format("has a face of vertex {}, beyond the last, {}", index, vertices - 1));
    return static_cast<int>(index);
  }

  std::string file_, bytes_;
  std::size_t at_ = 0;
};

}  // namespace

bool isMsh(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".msh";
}

Mesh readMsh(const std::filesystem::path& file, std::uintmax_t largest) {
  return MshReader(file, largest).read();
}

}  // namespace softgauss::io::mjcf
