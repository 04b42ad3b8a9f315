// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/manifold.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "softgauss/collision/contact_reduction.hpp"

namespace softgauss::collision {
namespace {

/// A corner in the contact plane: coordinates (x, y) along the tangents, height along n.
struct Corner {
  double x, y, height;
};

struct Polygon {
  static constexpr int kCapacity = 2 * SupportFace::kCapacity + 2;
  int count = 0;
  std::array<Corner, kCapacity> corners;

  void add(const Corner& c) {
    if (count < kCapacity) corners[static_cast<std::size_t>(count++)] = c;
  }
  const Corner& operator[](int i) const { return corners[static_cast<std::size_t>(i)]; }
};

/// Coordinates of the face in the columns (n, t1, t2) of R, from the point o.
Polygon project(const SupportFace& face, const Matrix3& R, const Vector3& o) {
  Polygon polygon;
  for (int i = 0; i < face.count; ++i) {
    const Vector3 x = R.transpose() * (face[i] - o);
    polygon.add({x.y(), x.z(), x.x()});
  }
  return polygon;
}

/// Height of a polygon's plane above (x, y): h0 + gx (x − x0) + gy (y − y0).
struct Plane {
  double x0 = 0, y0 = 0, h0 = 0, gx = 0, gy = 0;
  double at(double x, double y) const { return h0 + gx * (x - x0) + gy * (y - y0); }
};

/// Newell's normal (sums over the rim), which holds for slightly warped faces too. For a segment
/// the height varies along the segment only.
Plane planeOf(const Polygon& p) {
  Plane plane;
  for (int i = 0; i < p.count; ++i) {
    plane.x0 += p[i].x / p.count;
    plane.y0 += p[i].y / p.count;
    plane.h0 += p[i].height / p.count;
  }
  if (p.count == 2) {
    const double dx = p[1].x - p[0].x, dy = p[1].y - p[0].y;
    const double slope = (p[1].height - p[0].height) / (dx * dx + dy * dy);
    plane.gx = slope * dx;
    plane.gy = slope * dy;
    return plane;
  }
  double nx = 0, ny = 0, nz = 0;
  for (int i = 0; i < p.count; ++i) {
    const Corner &a = p[i], &b = p[(i + 1) % p.count];
    nx += (a.y - b.y) * (a.height + b.height);
    ny += (a.height - b.height) * (a.x + b.x);
    nz += (a.x - b.x) * (a.y + b.y);
  }
  plane.gx = -nx / nz;
  plane.gy = -ny / nz;
  return plane;
}

/// Twice the signed area seen against n; its sign tells the sense of the rim.
double doubleArea(const Polygon& p) {
  double area = 0.0;
  for (int i = 0; i < p.count; ++i) {
    const Corner &a = p[i], &b = p[(i + 1) % p.count];
    area += a.x * b.y - a.y * b.x;
  }
  return area;
}

/// Sutherland–Hodgman: the part of `subject` inside the convex polygon `window`. A subject of two
/// corners is an open segment.
Polygon clip(const Polygon& subject, const Polygon& window) {
  const double sense = doubleArea(window) < 0.0 ? -1.0 : 1.0;
  Polygon current = subject;
  for (int e = 0; e < window.count && current.count > 0; ++e) {
    const Corner &a = window[e], &b = window[(e + 1) % window.count];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (length == 0.0) continue;
    // Distance inside the edge; corners on it within rounding count as inside.
    const double tolerance = 1e-9 * length;
    const auto inside = [&](const Corner& c) {
      return sense * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / length + tolerance;
    };
    Polygon next;
    const bool open = current.count <= 2;
    if (open && inside(current[0]) >= 0.0) next.add(current[0]);
    const int edges = open ? current.count - 1 : current.count;
    for (int i = 0; i < edges; ++i) {
      const Corner &from = current[i], &to = current[(i + 1) % current.count];
      const double f = inside(from), g = inside(to);
      if ((f < 0.0) != (g < 0.0)) {
        const double s = f / (f - g);
        next.add({from.x + s * (to.x - from.x), from.y + s * (to.y - from.y),
                  from.height + s * (to.height - from.height)});
      }
      if (g >= 0.0) next.add(to);
    }
    current = next;
  }
  return current;
}

/// Ends of the stretch on which two segments lie side by side; nothing when they cross.
Polygon clipSegments(const Polygon& subject, const Polygon& window) {
  const double ux = window[1].x - window[0].x, uy = window[1].y - window[0].y;
  const double wx = subject[1].x - subject[0].x, wy = subject[1].y - subject[0].y;
  const double uu = ux * ux + uy * uy, ww = wx * wx + wy * wy, cross = ux * wy - uy * wx;
  Polygon none;
  if (cross * cross > 0.0025 * uu * ww) return none;
  const auto along = [&](const Corner& c) {
    return ((c.x - window[0].x) * ux + (c.y - window[0].y) * uy) / uu;
  };
  const double s0 = along(subject[0]), s1 = along(subject[1]);
  const double low = std::max(0.0, std::min(s0, s1)), high = std::min(1.0, std::max(s0, s1));
  if (high <= low) return none;
  Polygon stretch;
  for (double s : {low, high}) {
    const double f = (s - s0) / (s1 - s0);
    stretch.add({subject[0].x + f * wx, subject[0].y + f * wy,
                 subject[0].height + f * (subject[1].height - subject[0].height)});
  }
  return stretch;
}

/// Midway between the nearest points, seen along n, of two polygons side by side.
Corner betweenPolygons(const Polygon& p, const Polygon& q) {
  Corner middle{};
  double nearest = kInfinity;
  const auto cornersAgainstEdges = [&](const Polygon& corners, const Polygon& rim) {
    for (int i = 0; i < corners.count; ++i)
      for (int e = 0; e < rim.count; ++e) {
        const Corner &c = corners[i], &a = rim[e], &b = rim[(e + 1) % rim.count];
        const double ux = b.x - a.x, uy = b.y - a.y, uu = ux * ux + uy * uy;
        double s = uu > 0.0 ? ((c.x - a.x) * ux + (c.y - a.y) * uy) / uu : 0.0;
        s = std::clamp(s, 0.0, 1.0);
        const Corner on{a.x + s * ux, a.y + s * uy, a.height + s * (b.height - a.height)};
        const double distance = std::hypot(c.x - on.x, c.y - on.y);
        if (distance >= nearest) continue;
        nearest = distance;
        middle = {0.5 * (c.x + on.x), 0.5 * (c.y + on.y), 0.5 * (c.height + on.height)};
      }
  };
  cornersAgainstEdges(p, q);
  cornersAgainstEdges(q, p);
  return middle;
}

}  // namespace

void addFaceContacts(const SupportFace& faceA, const SupportFace& faceB, const PairContact& deepest,
                     double margin, PairContacts& out) {
  if (deepest.distance >= margin) return;
  if (faceA.count < 2 || faceB.count < 2) {
    out.add(deepest);
    return;
  }
  Matrix3 R;
  const Vector3& n = deepest.n_W;
  R << n, n.unitOrthogonal(), Vector3::Zero();
  R.col(2) = n.cross(R.col(1));
  const Vector3& o = deepest.p_WC;
  const Polygon a = project(faceA, R, o), b = project(faceB, R, o);

  // A segment is clipped by a polygon, never the reverse.
  const bool clipA = a.count == 2 && b.count > 2;
  const Polygon &subject = clipA ? a : b, &window = clipA ? b : a;
  const Polygon common = window.count == 2 ? clipSegments(subject, window) : clip(subject, window);
  if (common.count == 0) {
    // Segments cross at the deepest point. Faces that meet at their rims alone touch there.
    PairContact contact = deepest;
    if (window.count > 2) {
      const Corner c = betweenPolygons(a, b);
      contact.p_WC = o + R * Vector3(c.height, c.x, c.y);
    }
    out.add(contact);
    return;
  }
  const Plane plane = planeOf(window);
  const double sign = clipA ? -1.0 : 1.0;

  const auto corner = [&](int i) -> PairContact {
    const Corner& c = common[i];
    const double other = plane.at(c.x, c.y);
    // Rounding must not make a corner deeper than the support points.
    const double gap = std::max(sign * (c.height - other), deepest.distance);
    const Vector3 p = o + R * Vector3(0.5 * (c.height + other), c.x, c.y);
    return {p, n, gap};
  };
  double lowest = margin;
  for (int i = 0; i < common.count; ++i) lowest = std::min(lowest, corner(i).distance);

  const double depth = margin - deepest.distance;
  if (lowest - deepest.distance > 0.1 * depth) out.add(deepest);
  addReduced(n, common.count, margin, corner, out);
}

}  // namespace softgauss::collision
