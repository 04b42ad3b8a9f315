// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "apps/compare_mjpc/ilqg.hpp"

namespace softgauss::app {

void CostCurve::add(double seconds, double cost) {
  if (cost < this->cost()) points.emplace_back(seconds, cost);
}

double CostCurve::secondsTo(double cost) const {
  for (const auto& [time, value] : points)
    if (value <= cost) return time;
  return kInfinity;
}

double CostCurve::costAt(double seconds) const {
  double least = kInfinity;
  for (const auto& [time, value] : points)
    if (time <= seconds) least = value;
  return least;
}

void CostCurve::keepFaster(const CostCurve& other) {
  if (other.points.size() != points.size()) return;
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].first = std::min(points[i].first, other.points[i].first);
}

}  // namespace softgauss::app
