// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/surface_reduction.hpp"

#include <algorithm>

#include "softgauss/collision/contact_reduction.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss::collision::detail {
namespace {

/// Cosine of the angle, 2.6°, within which normals are of one neighbourhood.
constexpr double kOneNeighbourhood = 0.999;
/// Points nearer to each other than this, of the size of the shape, are one: what the normals of
/// one point may be off by, and twice that.
constexpr double kOnePoint = 2e-6;

}  // namespace

void SurfaceReduction::takeNeighbourhood(const std::vector<PairContact>& points,
                                         std::size_t first) {
  members_.clear();
  for (std::size_t i = first; i < points.size(); ++i) {
    if (taken_[i] || points[i].n_W.dot(points[first].n_W) < kOneNeighbourhood) continue;
    taken_[i] = 1;
    members_.push_back(static_cast<int>(i));
  }
}

/// Andrew's monotone chain (Information Processing Letters 9(5), 1979) of the members.
void SurfaceReduction::findRim(const std::vector<PairContact>& points, const Vector3& n) {
  const Vector3 u = n.unitOrthogonal(), w = n.cross(u);
  const Vector3& o = points[idx(members_[0])].p_WC;
  seen_.clear();
  double spread = 0.0;
  for (const int i : members_) {
    const Vector3 x = points[idx(i)].p_WC - o;
    seen_.push_back({u.dot(x), w.dot(x), i});
    spread = std::max(spread, x.squaredNorm());
  }
  std::sort(seen_.begin(), seen_.end(), [](const Seen& a, const Seen& b) {
    return a.x < b.x || (a.x == b.x && (a.y < b.y || (a.y == b.y && a.index < b.index)));
  });

  // Lower chain there, upper chain back; what lies on a straight line between others is no corner.
  const double straight = 1e-9 * spread;
  rim_.clear();
  const auto extend = [&](const Seen& c, std::size_t start) {
    const auto bends = [&] {
      const Seen &a = rim_[rim_.size() - 2], &b = rim_.back();
      return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > straight;
    };
    while (rim_.size() >= start + 2 && !bends()) rim_.pop_back();
    rim_.push_back(c);
  };
  for (const Seen& s : seen_) extend(s, 0);
  const std::size_t upper = rim_.size() - 1;
  for (auto s = seen_.rbegin() + 1; s != seen_.rend(); ++s) extend(*s, upper);
  if (rim_.size() > 1) rim_.pop_back();
}

void SurfaceReduction::keep(const std::vector<PairContact>& points, const Vector3& n, double margin,
                            double apart) {
  const auto add = [&](const PairContact& c) {
    for (const PairContact& k : kept_)
      if ((k.p_WC - c.p_WC).squaredNorm() < apart * apart && k.n_W.dot(c.n_W) > kOneNeighbourhood)
        return;
    kept_.push_back(c);
  };
  if (members_.size() <= 4) {
    for (const int i : members_) add(points[idx(i)]);
    return;
  }
  findRim(points, n);
  PairContacts few;
  addReduced(
      n, static_cast<int>(rim_.size()), margin,
      [&](int i) { return points[idx(rim_[idx(i)].index)]; }, few);
  double lowest = margin;
  for (int i = 0; i < few.count; ++i) {
    add(few[i]);
    lowest = std::min(lowest, few[i].distance);
  }
  const int deepest = *std::min_element(members_.begin(), members_.end(), [&](int i, int j) {
    return points[idx(i)].distance < points[idx(j)].distance;
  });
  const double distance = points[idx(deepest)].distance;
  if (lowest - distance > 0.1 * (margin - distance)) add(points[idx(deepest)]);
}

int SurfaceReduction::reduce(std::vector<PairContact>& points, double margin, double size) {
  if (points.size() < 2) return 0;
  taken_.assign(points.size(), 0);
  kept_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (taken_[i]) continue;
    takeNeighbourhood(points, i);
    keep(points, points[i].n_W, margin, kOnePoint * size);
  }
  const auto gone = static_cast<int>(points.size() - kept_.size());
  points.assign(kept_.begin(), kept_.end());
  return gone;
}

}  // namespace softgauss::collision::detail
