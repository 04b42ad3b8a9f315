// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/mesh_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// A letter of A to Z made small.
char small(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// The extension; keeps assimp from guessing a format by the content of a file that is something
/// else.
std::string formatOf(const fs::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), small);
  constexpr std::array<std::string_view, 5> kKnown = {".stl", ".obj", ".dae", ".gltf", ".glb"};
  if (std::find(kKnown.begin(), kKnown.end(), extension) == kKnown.end())
    failMesh(file, fmt::format("unknown format '{}', expected .stl, .obj, .dae, .gltf or .glb",
                               extension));
  return extension;
}

/// An ASCII STL begins with `solid`, in small letters, as assimp's reader wants it.
void prepareStl(std::string& text) {
  // A binary one holds zero bytes, whatever it begins with.
  if (text.find('\0') != std::string::npos) return;
  std::string_view rest = text;
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
  std::string begin(rest.substr(0, 5));
  std::transform(begin.begin(), begin.end(), begin.begin(), small);
  if (begin != "solid") return;
  text = std::string(rest);
  std::transform(text.begin(), text.end(), text.begin(), small);
}

std::string megabytes(std::uintmax_t bytes) {
  return fmt::format("{:.4g} MB", static_cast<double>(bytes) / (1 << 20));
}

}  // namespace

void failMesh(const fs::path& file, const std::string& problem, int line) {
  throw ModelError({file.string(), line}, "mesh", problem);
}

std::string readMeshBytes(const fs::path& path, std::uintmax_t largest) {
  std::error_code failed;
  if (!fs::is_regular_file(path, failed)) failMesh(path, "is no regular file, expected one");
  const std::uintmax_t size = fs::file_size(path, failed);
  if (failed) failMesh(path, fmt::format("cannot be read: {}", failed.message()));
  if (size > largest)
    failMesh(path, fmt::format("is larger than {}; a mesh of fewer triangles is as good for "
                               "contacts and simulates faster; --largest-mesh {} (MB) reads it",
                               megabytes(largest), size / (1 << 20) + 1));
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) failMesh(path, fmt::format("cannot be read: {}", std::strerror(errno)));
  std::string bytes(size, '\0');
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
  return bytes;
}

MeshFile loadMeshFile(const fs::path& path, std::uintmax_t largest) {
  MeshFile file;
  file.path = path;
  file.format = formatOf(path);
  file.text = readMeshBytes(path, largest);
  if (file.format == ".stl")
    prepareStl(file.text);
  else if (file.format != ".glb" && file.text.starts_with(kByteOrderMark))
    file.text.erase(0, kByteOrderMark.size());
  return file;
}

void checkObj(const MeshFile& file) {
  std::string_view rest = file.text;
  int line = 0;
  while (!rest.empty()) {
    // A line goes on where it ends in a back-slash.
    const int first = line + 1;
    std::size_t end = 0;
    for (bool more = true; more;) {
      end = std::min(rest.find('\n', end), rest.size());
      ++line;
      std::size_t last = end;
      if (last > 0 && rest[last - 1] == '\r') --last;
      more = end < rest.size() && last > 0 && rest[last - 1] == '\\';
      end += end < rest.size() ? 1 : 0;
    }
    const std::string_view text = rest.substr(0, end);
    rest.remove_prefix(end);
    if (text.size() <= 2 * kMostCorners) continue;  // a corner is a letter and a blank at least
    std::vector<std::string_view> parts = words(text);
    std::erase(parts, "\\");
    if (!parts.empty() && parts[0] == "f" && parts.size() - 1 > kMostCorners)
      failMesh(file.path,
               fmt::format("holds a polygon of {} corners, expected at most {}; try a mesh tool "
                           "that makes triangles of it",
                           parts.size() - 1, kMostCorners),
               first);
  }
}

}  // namespace softgauss::io::detail
