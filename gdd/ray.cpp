// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/ray.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/solver/line_search.hpp"

namespace softgauss::gdd {

Jet Ray::slopeAt(const BoundPenalty& bounds, double tau) const {
  Jet jet{0.0, smoothSlope_ + tau * smoothCurvature_, smoothCurvature_};
  for (Eigen::Index i = 0; i < y_.size(); ++i) {
    const Jet psi = bounds.at(i, y_[i] + tau * yRate_[i]);
    jet.slope += psi.slope * yRate_[i];
    jet.curvature += psi.curvature * yRate_[i] * yRate_[i];
  }
  return jet;
}

RayResult Ray::minimize(const Constraints& constraints, const TreeFactor& massFactor,
                        const BoundPenalty& bounds, const VectorX& g, const VectorX& rate,
                        double costSlope, double costCurvature, ContactForceTerms& forces) {
  crossings_.clear();
  constraints.findCrossings(crossings_);
  const auto later = [](const Crossing& a, const Crossing& b) {
    if (a.alpha != b.alpha) return a.alpha > b.alpha;
    return a.breakpoint > b.breakpoint;
  };
  std::make_heap(crossings_.begin(), crossings_.end(), later);

  RayResult result;
  g_ = g;
  rate_ = rate;
  for (;;) {
    // The quadratic of this interval.
    bounds.multiplyR(massFactor, rate_, Rrate_);
    bounds.limits.coordinates(g_, y_);
    bounds.limits.coordinates(rate_, yRate_);
    smoothSlope_ = g_.dot(Rrate_) + costSlope + result.alpha * costCurvature;
    if (const VectorX* free = bounds.freeSlope()) smoothSlope_ -= free->dot(rate_);
    smoothCurvature_ = rate_.dot(Rrate_) + costCurvature;
    if (forces.active()) {
      smoothSlope_ += forces.slope();
      smoothCurvature_ += forces.curvature();
    }
    const double length = crossings_.empty() ? kInfinity : crossings_.front().alpha - result.alpha;
    const Jet start = slopeAt(bounds, 0.0);
    if (!(start.slope < 0.0)) {
      result.kink = result.crossings > 0;
      return result;
    }
    if (!(std::isfinite(length) && slopeAt(bounds, length).slope < 0.0)) {
      // The slope vanishes in this interval.
      const double newton = start.curvature > 0.0 ? -start.slope / start.curvature : 1.0;
      result.alpha += exactLineSearch([&](double tau) { return slopeAt(bounds, tau); }, start.slope,
                                      {std::min(length, newton), length, 1e-12, 100})
                          .alpha;
      return result;
    }
    // On to the next interval.
    const Crossing crossing = crossings_.front();
    std::pop_heap(crossings_.begin(), crossings_.end(), later);
    crossings_.pop_back();
    g_ += length * rate_;
    constraints.addRow(crossing.breakpoint.row, crossing.curvatureJump * crossing.rate, rate_);
    forces.advance(length);
    forces.cross(crossing, constraints);
    result.alpha = crossing.alpha;
    result.last = crossing.breakpoint;
    ++result.crossings;
  }
}

}  // namespace softgauss::gdd
