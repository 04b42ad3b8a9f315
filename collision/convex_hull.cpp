// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/convex_hull.hpp"

#include <libqhull_r/qhull_ra.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <set>
#include <string>

#include "softgauss/engine/core/check.hpp"

namespace softgauss::collision {
namespace {

/// Single-precision mesh files carry this much rounding, relative to their size.
constexpr double kRelativeThickness = 1e-6;

ModelError meshError(const Mesh& mesh, const std::string& problem) {
  return {SourceLocation{mesh.file, 0}, "mesh", problem};
}

/// Points that span the mesh: two ends of a long diagonal, the vertex farthest from that line, and
/// the largest distance from the plane of the three.
struct Span {
  Vector3 origin;
  Vector3 x, y, normal;    ///< axes of the plane
  double length = 0.0;     ///< along x
  double width = 0.0;      ///< distance from the line
  double thickness = 0.0;  ///< distance from the plane
  double size = 0.0;       ///< largest coordinate or length: the scale of rounding
};

template <class Distance>
const Vector3& farthest(const std::vector<Vector3>& points, Distance&& distance) {
  return *std::max_element(points.begin(), points.end(), [&](const Vector3& a, const Vector3& b) {
    return distance(a) < distance(b);
  });
}

Span spanOf(const std::vector<Vector3>& points) {
  Span e;
  e.origin = farthest(points, [&](const Vector3& v) { return (v - points[0]).squaredNorm(); });
  const Vector3 far =
      farthest(points, [&](const Vector3& v) { return (v - e.origin).squaredNorm(); });
  e.length = (far - e.origin).norm();
  e.size = e.length;
  for (const Vector3& v : points) e.size = std::max(e.size, v.cwiseAbs().maxCoeff());
  if (e.length <= kRelativeThickness * e.size) return e;

  e.x = (far - e.origin) / e.length;
  const auto offLine = [&](const Vector3& v) -> Vector3 {
    return v - e.origin - e.x * e.x.dot(v - e.origin);
  };
  const Vector3 wide =
      offLine(farthest(points, [&](const Vector3& v) { return offLine(v).squaredNorm(); }));
  e.width = wide.norm();
  if (e.width <= kRelativeThickness * e.size) return e;

  e.y = wide / e.width;
  e.normal = e.x.cross(e.y);
  const Vector3 thick =
      farthest(points, [&](const Vector3& v) { return std::abs(e.normal.dot(v - e.origin)); });
  e.thickness = std::abs(e.normal.dot(thick - e.origin));
  return e;
}

/// Planar hull by the monotone chain, as a polygon with two sides.
ConvexHull flatHull(const std::vector<Vector3>& points, const Span& e) {
  std::vector<Eigen::Vector2d> flat;
  flat.reserve(points.size());
  for (const Vector3& v : points) flat.emplace_back(e.x.dot(v - e.origin), e.y.dot(v - e.origin));
  std::sort(flat.begin(), flat.end(), [](const auto& a, const auto& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });

  // Lower chain left to right, then upper chain back; nearly straight corners are dropped.
  const double straight = kRelativeThickness * e.size * e.length;
  std::vector<Eigen::Vector2d> ring;
  const auto extend = [&](const Eigen::Vector2d& v, std::size_t start) {
    const auto bends = [&] {
      const Eigen::Vector2d a = ring[ring.size() - 1] - ring[ring.size() - 2];
      const Eigen::Vector2d b = v - ring[ring.size() - 1];
      return a.x() * b.y() - a.y() * b.x() > straight * 1e-3;
    };
    while (ring.size() >= start + 2 && !bends()) ring.pop_back();
    ring.push_back(v);
  };
  for (const Eigen::Vector2d& v : flat) extend(v, 0);
  const std::size_t upper = ring.size() - 1;
  for (auto v = flat.rbegin() + 1; v != flat.rend(); ++v) extend(*v, upper);
  ring.pop_back();

  ConvexHull hull;
  hull.flat = true;
  hull.faces.resize(2);
  hull.faces[0].normal = e.normal;
  hull.faces[1].normal = -e.normal;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    hull.vertices.push_back(e.origin + e.x * ring[i].x() + e.y * ring[i].y());
    hull.faces[0].vertices.push_back(static_cast<int>(i));
  }
  hull.faces[1].vertices.assign(hull.faces[0].vertices.rbegin(), hull.faces[0].vertices.rend());
  return hull;
}

/// Owner of one run of qhull; its messages are dropped.
class Qhull {
 public:
  explicit Qhull(std::vector<double> coordinates)
      : coordinates_(std::move(coordinates)), sink_(std::tmpfile()) {
    qh_zero(&state_, sink_);
    char command[] = "qhull";
    failed_ =
        sink_ == nullptr || qh_new_qhull(&state_, 3, static_cast<int>(coordinates_.size() / 3),
                                         coordinates_.data(), False, command, nullptr, sink_) != 0;
  }
  ~Qhull() {
    int kept = 0, blocks = 0;
    qh_freeqhull(&state_, qh_ALL);
    qh_memfreeshort(&state_, &kept, &blocks);
    if (sink_ != nullptr) std::fclose(sink_);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  bool failed() const { return failed_; }

  /// Calls visit(outward normal, ordered input indices) for every face.
  template <class Visit>
  void forFaces(Visit&& visit) {
    qhT* qh = &state_;  // the name that qhull's macros expect
    facetT* facet;
    FORALLfacets {
      std::vector<int> ring;
      setT* vertices = qh_facet3vertex(qh, facet);
      vertexT *vertex, **vertexp;
      FOREACHvertex_(vertices) ring.push_back(qh_pointid(qh, vertex->point));
      qh_settempfree(qh, &vertices);
      visit(Vector3(facet->normal[0], facet->normal[1], facet->normal[2]), ring);
    }
  }

 private:
  qhT state_;
  std::vector<double> coordinates_;
  std::FILE* sink_;
  bool failed_ = true;
};

ConvexHull solidHull(const Mesh& mesh) {
  std::vector<double> coordinates;
  coordinates.reserve(3 * mesh.vertices.size());
  for (const Vector3& v : mesh.vertices)
    coordinates.insert(coordinates.end(), v.data(), v.data() + 3);
  Qhull qhull(std::move(coordinates));
  if (qhull.failed()) throw meshError(mesh, "its convex hull cannot be computed");

  // Indices of the hull's vertices follow the order of the mesh, so the result is deterministic.
  ConvexHull hull;
  std::map<int, int> indexOf;
  qhull.forFaces([&](const Vector3& normal, const std::vector<int>& ring) {
    for (int i : ring) indexOf.emplace(i, 0);
    hull.faces.push_back({normal, ring});
  });
  for (auto& [original, index] : indexOf) {
    index = static_cast<int>(hull.vertices.size());
    hull.vertices.push_back(mesh.vertices[static_cast<std::size_t>(original)]);
  }
  for (HullFace& face : hull.faces) {
    for (int& i : face.vertices) i = indexOf.at(i);
    // The order of the ring is made counter-clockwise about the outward normal.
    Vector3 area = Vector3::Zero();
    const Vector3& first = hull.vertices[static_cast<std::size_t>(face.vertices[0])];
    for (std::size_t k = 1; k + 1 < face.vertices.size(); ++k)
      area += (hull.vertices[static_cast<std::size_t>(face.vertices[k])] - first)
                  .cross(hull.vertices[static_cast<std::size_t>(face.vertices[k + 1])] - first);
    if (area.dot(face.normal) < 0.0) std::reverse(face.vertices.begin(), face.vertices.end());
  }
  return hull;
}

IndexLists flatten(const std::vector<std::set<int>>& lists) {
  IndexLists flat;
  flat.start.push_back(0);
  for (const std::set<int>& list : lists) {
    flat.indices.insert(flat.indices.end(), list.begin(), list.end());
    flat.start.push_back(static_cast<int>(flat.indices.size()));
  }
  return flat;
}

/// Neighbours along the rims of the faces, and starting points for the climb.
void connect(ConvexHull& hull) {
  std::vector<std::set<int>> neighbours(hull.vertices.size()), around(hull.vertices.size());
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    const std::vector<int>& ring = hull.faces[f].vertices;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const int a = ring[k], b = ring[(k + 1) % ring.size()];
      neighbours[static_cast<std::size_t>(a)].insert(b);
      neighbours[static_cast<std::size_t>(b)].insert(a);
      around[static_cast<std::size_t>(a)].insert(static_cast<int>(f));
    }
  }
  hull.neighbours = flatten(neighbours);
  hull.facesAround = flatten(around);
  for (int i = 0; i < 8; ++i) {
    const Vector3 d((i & 1) ? 1.0 : -1.0, (i & 2) ? 1.0 : -1.0, (i & 4) ? 1.0 : -1.0);
    const auto top =
        std::max_element(hull.vertices.begin(), hull.vertices.end(),
                         [&](const Vector3& a, const Vector3& b) { return a.dot(d) < b.dot(d); });
    hull.octants[static_cast<std::size_t>(i)] = static_cast<int>(top - hull.vertices.begin());
  }
}

}  // namespace

int ConvexHull::supportVertex(const Vector3& d_G) const {
  int best = octants[static_cast<std::size_t>((d_G.x() > 0.0) + 2 * (d_G.y() > 0.0) +
                                              4 * (d_G.z() > 0.0))];
  double farthest = vertices[static_cast<std::size_t>(best)].dot(d_G);
  for (int from = -1; from != best;) {
    from = best;
    const auto at = static_cast<std::size_t>(from);
    const auto end = static_cast<std::size_t>(neighbours.start[at + 1]);
    for (auto k = static_cast<std::size_t>(neighbours.start[at]); k < end; ++k) {
      const double reach = neighbourPoints[k].dot(d_G);
      if (reach > farthest) farthest = reach, best = neighbours.indices[k];
    }
  }
  return best;
}

int ConvexHull::supportFace(const Vector3& d_G) const {
  const std::span<const int> around = facesAround.of(supportVertex(d_G));
  const auto along = [&](int f) { return faces[static_cast<std::size_t>(f)].normal.dot(d_G); };
  return *std::max_element(around.begin(), around.end(),
                           [&](int f, int g) { return along(f) < along(g); });
}

ConvexHull makeConvexHull(const Mesh& mesh) {
  if (mesh.vertices.size() < 3)
    throw meshError(mesh, "fewer than three vertices, a surface was expected");
  for (const Vector3& v : mesh.vertices)
    if (!v.allFinite()) throw meshError(mesh, "a vertex is not finite");

  const Span extent = spanOf(mesh.vertices);
  const double tolerance = kRelativeThickness * extent.size;
  if (extent.width <= tolerance)
    throw meshError(mesh, "all its vertices lie on one line, a surface was expected");
  ConvexHull hull =
      extent.thickness <= tolerance ? flatHull(mesh.vertices, extent) : solidHull(mesh);

  connect(hull);
  for (const int i : hull.neighbours.indices)
    hull.neighbourPoints.push_back(hull.vertices[static_cast<std::size_t>(i)]);

  Vector3 lower = hull.vertices[0], upper = hull.vertices[0];
  for (const Vector3& v : hull.vertices) {
    lower = lower.cwiseMin(v);
    upper = upper.cwiseMax(v);
  }
  hull.centre = 0.5 * (lower + upper);
  hull.halfExtents = 0.5 * (upper - lower);
  for (const Vector3& v : hull.vertices)
    hull.boundingRadius = std::max(hull.boundingRadius, (v - hull.centre).norm());
  return hull;
}

Mesh triangulated(const ConvexHull& hull) {
  Mesh mesh;
  mesh.vertices = hull.vertices;
  for (const HullFace& face : hull.faces)
    for (std::size_t i = 2; i < face.vertices.size(); ++i)
      mesh.triangles.push_back({face.vertices[0], face.vertices[i - 1], face.vertices[i]});
  return mesh;
}

}  // namespace softgauss::collision
