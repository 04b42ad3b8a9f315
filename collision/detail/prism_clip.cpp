// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/prism_clip.hpp"

namespace softgauss::collision::detail {
namespace {

constexpr int kFace = -1;  ///< a line of the face itself, no side

struct Corner {
  Vector3 x;
  int next;       ///< the side on which the next corner lies too, or kFace
  bool isCorner;  ///< of the face over all triangles of the plane
};

struct Cut {
  int count = 0;
  std::array<Corner, ClippedFace::kCapacity> corners;

  void add(const Corner& c) {
    if (count < ClippedFace::kCapacity) corners[static_cast<std::size_t>(count++)] = c;
  }
  const Corner& operator[](int i) const { return corners[static_cast<std::size_t>(i)]; }
};

/// Whether a line and side k meet in a corner that all triangles of the plane leave.
bool isCornerOf(const PlanePiece& piece, int line, int k) {
  if (line == kFace) return !piece.isInner[static_cast<std::size_t>(k)];
  // Side i ends where side i + 1 begins.
  const int corner = (line + 1) % 3 == k ? k : line;
  return piece.turns[static_cast<std::size_t>(corner)];
}

/// Leaves what is not beyond side k; `beyond` is a distance times any factor.
template <class Beyond>
Cut cutOff(const Cut& cut, const PlanePiece& piece, int k, Beyond&& beyond) {
  Cut left;
  const bool open = cut.count <= 2;
  if (open && beyond(cut[0].x) <= 0.0) left.add(cut[0]);
  for (int i = 0; i < (open ? cut.count - 1 : cut.count); ++i) {
    const Corner &from = cut[i], &to = cut[(i + 1) % cut.count];
    const double f = beyond(from.x), g = beyond(to.x);
    // The way out follows the side, the way in the line that was cut.
    if ((f > 0.0) != (g > 0.0))
      left.add({from.x + f / (f - g) * (to.x - from.x), g > 0.0 ? k : from.next,
                isCornerOf(piece, from.next, k)});
    if (g <= 0.0) left.add(to);
  }
  return left;
}

}  // namespace

ClippedFace clipToPrism(const SupportFace& face, const PlanePiece& piece, const Vector3& m) {
  Cut cut;
  for (int i = 0; i < face.count; ++i) cut.add({face[i], kFace, true});
  for (int k = 0; k < 3 && cut.count > 0; ++k) {
    const Vector3& a = piece.triangle.corners[static_cast<std::size_t>(k)];
    const Vector3 edge = piece.triangle.corners[static_cast<std::size_t>((k + 1) % 3)] - a;
    const Vector3 outwards = edge.cross(m);
    // What lies on a side within rounding counts as inside, on both triangles that share it.
    const double tolerance = 1e-9 * edge.squaredNorm();
    cut = cutOff(cut, piece, k, [&](const Vector3& x) { return outwards.dot(x - a) - tolerance; });
  }
  ClippedFace left;
  for (int i = 0; i < cut.count; ++i)
    if (cut[i].isCorner) left.add(cut[i].x);
  return left;
}

}  // namespace softgauss::collision::detail
