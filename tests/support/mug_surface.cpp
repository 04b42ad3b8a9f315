// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "tests/support/sample_surfaces.hpp"

namespace softgauss::test {
namespace {

constexpr int kSectors = 32, kLevels = 16;  ///< of the outer wall
constexpr int kUpper = 13;                  ///< level of the handle's upper end
constexpr int kLower = kLevels - kUpper;
constexpr int kSteps = 16;  ///< of the handle

class Mug {
 public:
  Mug(double radius, double halfHeight, double wall)
      : radius_(radius), half_(halfHeight), wall_(wall) {
    mesh->file = "mug";
    addCup();
    addHandle();
  }
  std::shared_ptr<Mesh> mesh = std::make_shared<Mesh>();

 private:
  void addQuad(int a, int b, int c, int d) {
    mesh->triangles.push_back({a, b, c});
    mesh->triangles.push_back({a, c, d});
  }
  /// Returns its first vertex.
  int addRing(double r, double z) {
    const auto first = static_cast<int>(mesh->vertices.size());
    for (int j = 0; j < kSectors; ++j) {
      const double angle = 2 * M_PI * j / kSectors;
      mesh->vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    return first;
  }
  static int outer(int level, int j) { return kSectors * level + (j + kSectors) % kSectors; }
  /// Two by two cells of the outer wall are left out about each end of the handle.
  static bool isHole(int level, int j) {
    const bool isEnd =
        level == kUpper - 1 || level == kUpper || level == kLower - 1 || level == kLower;
    return isEnd && (j == 0 || j == kSectors - 1);
  }

  void addCup() {
    for (int level = 0; level <= kLevels; ++level) addRing(radius_, height(level));
    const int rim = addRing(radius_ - wall_, half_),
              floor = addRing(radius_ - wall_, wall_ - half_);
    const auto below = static_cast<int>(mesh->vertices.size());
    mesh->vertices.emplace_back(0.0, 0.0, -half_);
    mesh->vertices.emplace_back(0.0, 0.0, wall_ - half_);
    for (int j = 0; j < kSectors; ++j) {
      const int n = (j + 1) % kSectors;
      for (int level = 0; level < kLevels; ++level)
        if (!isHole(level, j))
          addQuad(outer(level, j), outer(level, n), outer(level + 1, n), outer(level + 1, j));
      addQuad(outer(kLevels, j), outer(kLevels, n), rim + n, rim + j);
      addQuad(rim + j, rim + n, floor + n, floor + j);
      mesh->triangles.push_back({floor + j, floor + n, below + 1});
      mesh->triangles.push_back({outer(0, n), outer(0, j), below});
    }
  }

  /// Sections from the rim of the upper hole to that of the lower one.
  void addHandle() {
    std::array<std::array<int, 8>, kSteps + 1> sections;
    for (std::size_t k = 0; k <= kSteps; ++k)
      for (std::size_t i = 0; i < 8; ++i)
        sections[k][i] = sectionVertex(static_cast<int>(k), kAround[i][0], kAround[i][1]);
    for (std::size_t k = 0; k < kSteps; ++k)
      for (std::size_t i = 0; i < 8; ++i) {
        const std::size_t n = (i + 1) % 8;
        addQuad(sections[k][i], sections[k][n], sections[k + 1][n], sections[k + 1][i]);
      }
  }

  /// `out` is away from the middle of the handle's half ellipse.
  int sectionVertex(int k, int across, int out) {
    if (k == 0) return outer(kUpper + out, across);
    if (k == kSteps) return outer(kLower - out, across);
    const double s = M_PI * k / kSteps, high = height(kUpper);
    const Vector3 away =
        Vector3(std::sin(s) / kMugHandleReach, 0.0, std::cos(s) / high).normalized();
    const Vector3 centre(radius_ + kMugHandleReach * std::sin(s), 0.0, high * std::cos(s));
    const Vector3 aside = (across * Vector3::UnitY() + out * away).normalized();
    mesh->vertices.push_back(centre + kMugHandleRadius * aside);
    return static_cast<int>(mesh->vertices.size()) - 1;
  }

  double height(int level) const { return half_ * (2.0 * level / kLevels - 1.0); }

  static constexpr int kAround[8][2] = {{-1, -1}, {0, -1}, {1, -1}, {1, 0},
                                        {1, 1},   {0, 1},  {-1, 1}, {-1, 0}};
  double radius_, half_, wall_;
};

}  // namespace

MeshPointer mugSurface(double radius, double halfHeight, double wall) {
  return Mug(radius, halfHeight, wall).mesh;
}

}  // namespace softgauss::test
