// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "softgauss/collision/box_pairs.hpp"
#include "softgauss/collision/segment_contacts.hpp"
#include "softgauss/engine/core/check.hpp"

namespace softgauss::collision {
namespace {

/// The segment x(t) = c + t u, |t| ≤ L, in the frame of a box of half extents h.
struct Segment {
  Vector3 c, u, h;
  double L;

  Vector3 at(double t) const { return c + u * t; }
  Vector3 excess(double t) const {
    const Vector3 x = at(t);
    return x - x.cwiseMax(-h).cwiseMin(h);
  }
  /// Half the derivative of the squared distance to the box: non-decreasing in t.
  double slope(double t) const { return u.dot(excess(t)); }
};

/// The t at which the distance to the box is least; the middle when a whole stretch is nearest.
/// `low` and `high` are the ends of that stretch.
double nearestParameter(const Segment& s, double& low, double& high) {
  std::array<double, 8> breaks;
  int count = 0;
  const auto insert = [&](double t) {
    if (t > -s.L && t < s.L) breaks[static_cast<std::size_t>(count++)] = t;
  };
  breaks[static_cast<std::size_t>(count++)] = -s.L;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(s.u[i]) < 1e-14) continue;
    insert((-s.h[i] - s.c[i]) / s.u[i]);
    insert((s.h[i] - s.c[i]) / s.u[i]);
  }
  std::sort(breaks.begin() + 1, breaks.begin() + count);
  breaks[static_cast<std::size_t>(count++)] = s.L;

  // Between breakpoints the slope is linear; rounding about zero counts as zero.
  const double zero = 1e-14 * (s.h.maxCoeff() + s.L);
  low = -s.L;
  high = s.L;
  double before = s.slope(-s.L);
  if (before > zero) return high = low;
  bool found = before >= -zero;
  for (std::size_t k = 1; k < static_cast<std::size_t>(count); ++k) {
    const double after = s.slope(breaks[k]);
    const double from = breaks[k - 1], to = breaks[k];
    if (!found && after >= -zero) {
      found = true;
      low = after <= zero ? to : from - before * (to - from) / (after - before);
    }
    if (found && after > zero) {
      high = before >= -zero ? from : low;
      return 0.5 * (low + high);
    }
    before = after;
  }
  if (!found) low = s.L;
  return 0.5 * (low + high);
}

/// A way out of the box for a segment that cuts it: the separating axis of least overlap.
struct Exit {
  Vector3 outward = Vector3::Zero();  ///< unit, from the box to the segment
  double overlap = kInfinity;         ///< ≥ 0
  int edge = -1;                      ///< axis of the box edge when outward = ±u × e, else −1
};

/// An edge is taken only when it is clearly better than every face, as in separateBoxes().
Exit exitOf(const Segment& s) {
  Exit best;
  int axis = 0;
  const Vector3 overlap = s.h + s.u.cwiseAbs() * s.L - s.c.cwiseAbs();
  best.overlap = overlap.minCoeff(&axis);
  best.outward[axis] = std::copysign(1.0, s.c[axis]);
  double needed = best.overlap - 1e-3 * s.h.maxCoeff();
  for (int i = 0; i < 3; ++i) {
    const Vector3 cross = s.u.cross(Vector3::Unit(i));
    const double sine = cross.norm();
    if (sine < 1e-3) continue;
    const double centre = cross.dot(s.c) / sine;
    const double edgeOverlap = cross.cwiseAbs().dot(s.h) / sine - std::abs(centre);
    if (edgeOverlap >= needed) continue;
    needed = edgeOverlap;
    best = {cross * (std::copysign(1.0, centre) / sine), edgeOverlap, i};
  }
  return best;
}

/// The t at which the segment is nearest to the box edge farthest along `outward`.
double parameterAtEdge(const Segment& s, const Exit& exit) {
  Vector3 corner;
  for (int k = 0; k < 3; ++k) corner[k] = std::copysign(s.h[k], exit.outward[k]);
  const Vector3 across = s.u - Vector3::Unit(exit.edge) * s.u[exit.edge];
  return std::clamp(across.dot(corner - s.c) / across.squaredNorm(), -s.L, s.L);
}

/// Unit vector out of the box and height above it.
struct Height {
  Vector3 outward;
  double value;
};

}  // namespace

void capsuleBox(const Shape& capsule, const Transform& X_WA, const Shape& box,
                const Transform& X_WB, double margin, PairContacts& out) {
  const Vector3& h = box.halfExtents;
  const double r = capsule.radius;
  const Segment s{X_WB.R.transpose() * (X_WA.p - X_WB.p), X_WB.R.transpose() * X_WA.R.col(2), h,
                  capsule.halfLength};

  // Away from the box along one of its axes: no contact.
  const Vector3 apart = s.c.cwiseAbs() - s.u.cwiseAbs() * s.L - h;
  if (apart.maxCoeff() >= r + margin) return;

  double low = 0.0, high = 0.0;
  double t = nearestParameter(s, low, high);
  Vector3 face = Vector3::Zero();  // outward normal that all points share when inside
  const double inside = 1e-12 * h.maxCoeff();
  if (s.excess(t).norm() <= inside) {
    const Exit exit = exitOf(s);
    if (exit.edge >= 0) {
      const Vector3 n = -(X_WB.R * exit.outward);
      const double distance = -exit.overlap - r;
      const Vector3 x = X_WA.p + X_WA.R.col(2) * parameterAtEdge(s, exit);
      out.add(x + n * (r + 0.5 * distance), n, distance);
      return;
    }
    face = exit.outward;
    const double fall = face.dot(s.u);  // along the segment, towards +t
    if (std::abs(fall) > 1e-12) t = fall < 0.0 ? high : low;
  }

  const bool sunk = !face.isZero(0.0);
  const auto heightAt = [&](double at) -> Height {
    if (sunk) return {face, face.dot(s.at(at)) - face.cwiseAbs().dot(h)};
    const Vector3 excess = s.excess(at);
    const double length = excess.norm();
    if (length > inside) return {excess / length, length};
    int axis = 0;
    const Vector3 x = s.at(at);
    const double below = (x.cwiseAbs() - h).maxCoeff(&axis);
    Vector3 outward = Vector3::Zero();
    outward[axis] = std::copysign(1.0, x[axis]);
    return {outward, below};
  };
  const auto contactAt = [&](double at) -> PairContact {
    const Height height = heightAt(at);
    const double distance = height.value - r;
    const Vector3 n = -(X_WB.R * height.outward);
    return {X_WA.p + X_WA.R.col(2) * at + n * (r + 0.5 * distance), n, distance};
  };

  const PairContact nearest = contactAt(t);
  if (nearest.distance >= margin) return;

  // The stretch over the face: the segment cut by the sides between which its nearest point lies.
  const Vector3 outward = heightAt(t).outward;
  int up = 0;
  outward.cwiseAbs().maxCoeff(&up);
  const Vector3 x = s.at(t);
  low = -s.L;
  high = s.L;
  for (int i = 0; i < 3; ++i) {
    if (i == up || std::abs(x[i]) > h[i] * (1.0 + 1e-9) || std::abs(s.u[i]) < 1e-14) continue;
    const double a = (-h[i] - s.c[i]) / s.u[i], b = (h[i] - s.c[i]) / s.u[i];
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
  const double tilt = s.u.dot(outward);
  const double shortest = std::max(0.5 * r, 1e-15);
  const double lambda = alongside(tilt * tilt) * std::clamp((high - low) / shortest, 0.0, 1.0);
  if (lambda == 0.0) {
    out.add(nearest);
    return;
  }
  const double fraction = std::clamp((t - low) / (high - low), 0.0, 1.0);
  addSegmentContacts(nearest, contactAt(low), contactAt(high), fraction, lambda, margin, out);
}

}  // namespace softgauss::collision
