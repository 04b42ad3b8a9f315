// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/curved_ray.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::gdd {

CurvedRay::CurvedRay(const Model& model)
    : base_(VectorX::Zero(model.nv)),
      g_(VectorX::Zero(model.nv)),
      rate_(VectorX::Zero(model.nv)),
      y_(VectorX::Zero(model.nv)),
      yRate_(VectorX::Zero(model.nv)),
      Rg_(VectorX::Zero(model.nv)) {}

RayResult CurvedRay::minimize(Constraints& constraints, const TreeFactor& massFactor,
                              const BoundPenalty& bounds, const VectorX& g, const VectorX& Md,
                              double costSlope, double costCurvature, ContactForceTerms& forces) {
  constexpr int kMaxEvaluations = 100;
  constexpr double kSlope = 1e-9;      // at the result, of that at the start
  constexpr double kRounding = 1e-14;  // of Φ
  constexpr double kBeside = 1e-10;    // of a breakpoint, relative

  crossings_.clear();
  constraints.findCrossings(crossings_);
  std::sort(crossings_.begin(), crossings_.end(),
            [](const Crossing& a, const Crossing& b) { return a.alpha < b.alpha; });

  // Without the rows' forces g is affine: base + α M d.
  base_ = g;
  constraints.addForce(base_);
  double at = 0.0;
  const auto phi = [&](double alpha) {
    bool changed = false;
    constraints.advance(alpha - at);
    at = alpha;
    constraints.evaluate(changed);
    g_ = -base_ - alpha * Md;
    constraints.addForce(g_);
    g_ = -g_;
    rate_ = -Md;
    constraints.addForceRate(rate_);
    rate_ = -rate_;
    bounds.multiplyR(massFactor, g_, Rg_);
    bounds.limits.coordinates(g_, y_);
    bounds.limits.coordinates(rate_, yRate_);
    Jet jet{0.5 * g_.dot(Rg_) + alpha * (costSlope + 0.5 * alpha * costCurvature),
            Rg_.dot(rate_) + costSlope + alpha * costCurvature, 0.0};
    if (const VectorX* free = bounds.freeSlope()) {
      jet.value -= free->dot(g_);
      jet.slope -= free->dot(rate_);
    }
    if (forces.active()) {
      forces.evaluate(constraints);
      forces.setRate(constraints);
      jet.value += forces.value();
      jet.slope += forces.slope();
    }
    for (Eigen::Index i = 0; i < y_.size(); ++i) {
      const Jet psi = bounds.at(i, y_[i]);
      jet.value += psi.value;
      jet.slope += psi.slope * yRate_[i];
    }
    return jet;
  };

  RayResult result;
  const Jet start = phi(0.0);
  if (!(start.slope < 0.0)) return result;
  const double ceiling = start.value + kRounding * (std::abs(start.value) + bounds.freeCost());
  double lower = 0.0, upper = kInfinity;
  double lowerSlope = start.slope, upperSlope = kNaN;  // NaN: no use for a secant
  // Looks at α and draws the bracket around the minimum; true where it is there.
  const auto narrow = [&](double alpha) {
    const Jet jet = phi(alpha);
    const bool low = jet.value <= ceiling;
    if (low && jet.slope < 0.0)
      lower = alpha, lowerSlope = jet.slope;
    else
      upper = alpha, upperSlope = low ? jet.slope : kNaN;
    return low && std::abs(jet.slope) <= kSlope * -start.slope;
  };

  double alpha = 1.0;
  for (int i = 0; i < kMaxEvaluations; ++i) {
    if (narrow(alpha)) {
      result.alpha = alpha;
      return result;
    }
    if (!std::isfinite(upper)) {
      alpha *= 2.0;
      continue;
    }
    // The breakpoints inside the bracket, halved; then what is left is smooth.
    const auto inside = [&](double a) {
      return a * (1.0 - kBeside) > lower && a * (1.0 + kBeside) < upper;
    };
    const auto first = std::find_if(crossings_.begin(), crossings_.end(),
                                    [&](const Crossing& c) { return inside(c.alpha); });
    const auto end =
        std::find_if(first, crossings_.end(), [&](const Crossing& c) { return !inside(c.alpha); });
    if (first != end) {
      const Crossing& breakpoint = *(first + (end - first) / 2);
      const double before = breakpoint.alpha * (1.0 - kBeside),
                   after = breakpoint.alpha * (1.0 + kBeside);
      if (narrow(before)) {
        result.alpha = before;
        return result;
      }
      if (upper == before) {
        alpha = 0.5 * (lower + upper);
        continue;
      }
      narrow(after);
      if (upper == after) {
        result.alpha = breakpoint.alpha;
        result.last = breakpoint.breakpoint;
        result.kink = true;
        return result;
      }
      alpha = 0.5 * (lower + upper);
      continue;
    }
    if (upper - lower <= kBeside * upper) break;
    const double secant = (lower * upperSlope - upper * lowerSlope) / (upperSlope - lowerSlope);
    const bool useful = secant > lower && secant < upper;  // false for NaN
    alpha = useful && i % 3 != 2 ? secant : 0.5 * (lower + upper);
  }
  result.alpha = lower;
  result.bend = true;
  return result;
}

}  // namespace softgauss::gdd
