// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/elliptic_contact.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss {

void EllipticContact::begin() {
  clearBlocks();
  cones_.clear();
  perInertia_.clear();
  reference.clear();
}

void EllipticContact::add(const Assembly& in, int i, const PairSurface& pair, const Touch& touch) {
  if (touch.frictionDim == 0) return;
  const Options& options = in.model.options;
  const BlockMotion moves = addBlock(in, i, pair, touch, static_cast<int>(reference.size()));
  Softness soft = soften(in, touch, moves.velocity);
  const double ratio = touch.mu() / std::sqrt(options.impedanceRatio);
  double push = soft.referenceAcceleration(moves.velocity[0], touch.distance);
  if (options.correctsSlip())
    soft = soft.hardened(levelCone(slipOf(in, touch, soft, moves), ratio, push));
  perInertia_.push_back(soft.perInertia);
  cones_.push_back({touch.frictionDim + 1, 1.0 / soft.R, ratio, touch.friction});
  reference.push_back(push - moves.bias[0]);
  for (int k = 1; k <= touch.frictionDim; ++k)
    reference.push_back(-soft.damping * moves.velocity[k] - moves.bias[k]);
}

void EllipticContact::finish() {
  for (std::vector<double>* column : {&x, &dx, &f, &df}) column->resize(reference.size());
  zones_.assign(cones_.size(), ConeZone::top);
  placed_.assign(cones_.size(), false);
  indexRows(reference.size());
  selection.reset(reference.size());
}

void EllipticContact::assemble(const Assembly& in) {
  begin();
  PairSurface pair;
  if (in.model.options.cone == Cone::elliptic)
    for (int i = 0; i < in.contacts.size(); ++i)
      if (const std::optional<Touch> touch = touchAt(in, i, pair)) add(in, i, pair, *touch);
  finish();
}

template <class Acceleration>
void EllipticContact::multiply(const Acceleration& a, std::vector<double>& y) const {
  forEachContact(selection,
                 [&](int i) { jacobian_.multiply(i, a, y.data() + contactsWithRows_[i].row); });
}

double EllipticContact::evaluate(std::size_t i, const double* at, double* force, double* H,
                                 ConeZone& zone) const {
  const EllipticCone::Point z = cones_[i].point(at);
  zone = placed_[i] ? zones_[i] : z.zone();
  return cones_[i].at(z, zone, force, H);
}

double EllipticContact::evaluate(bool& cellChanged) {
  double cost = 0.0;
  forEachContact(selection, [&](int i) {
    ConeZone zone;
    cost += evaluate(i, x.data() + contactsWithRows_[i].row, f.data() + contactsWithRows_[i].row,
                     nullptr, zone);
    // The middle zone bends: there the curvature changes with every step.
    cellChanged |= placed_[i] || zone != zones_[i] || zone == ConeZone::middle;
    zones_[i] = zone;
  });
  return cost;
}

void EllipticContact::along(double alpha, Jet& sum) const {
  forEachContact(selection, [&](int i) {
    const int dim = cones_[i].dim;
    const double *from = x.data() + contactsWithRows_[i].row,
                 *rate = dx.data() + contactsWithRows_[i].row;
    double at[EllipticCone::kMaxDim], force[EllipticCone::kMaxDim];
    double H[EllipticCone::kMaxDim * EllipticCone::kMaxDim];
    for (int k = 0; k < dim; ++k) at[k] = from[k] + alpha * rate[k];
    ConeZone zone;
    sum.value += evaluate(i, at, force, H, zone);
    if (zone == ConeZone::top) return;
    for (int k = 0; k < dim; ++k) {
      sum.slope -= force[k] * rate[k];
      for (int l = 0; l < dim; ++l) sum.curvature += rate[k] * H[k * dim + l] * rate[l];
    }
  });
}

void EllipticContact::advance(double alpha) {
  selection.forEach([&](std::size_t i) { x[i] += alpha * dx[i]; });
}

void EllipticContact::setForceRate() {
  for (std::size_t i = 0; i < contactsWithRows_.size(); ++i) {
    const int dim = cones_[i].dim;
    const std::size_t first = static_cast<std::size_t>(contactsWithRows_[i].row);
    double force[EllipticCone::kMaxDim], H[EllipticCone::kMaxDim * EllipticCone::kMaxDim];
    ConeZone zone;
    evaluate(i, x.data() + first, force, H, zone);
    for (int k = 0; k < dim; ++k) {
      df[first + k] = 0.0;
      for (int l = 0; l < dim; ++l) df[first + k] -= H[k * dim + l] * dx[first + l];
    }
  }
}

ContactBlocks::FrameVector EllipticContact::frameForce(int i) const {
  FrameVector frame{};
  std::copy_n(f.data() + contactsWithRows_[i].row, cones_[i].dim, frame.data());
  return frame;
}

ContactBlocks::FrameVector EllipticContact::frameForceRate(int i) const {
  FrameVector frame{};
  std::copy_n(df.data() + contactsWithRows_[i].row, cones_[i].dim, frame.data());
  return frame;
}

int EllipticContact::frameCurvature(int i, double* H) const {
  double force[EllipticCone::kMaxDim];
  ConeZone zone;
  evaluate(static_cast<std::size_t>(i), x.data() + contactsWithRows_[i].row, force, H, zone);
  return cones_[i].dim;
}

template <class Forces>
void EllipticContact::addTransposed(const std::vector<double>& y, Forces& tau) const {
  forEachContact(selection, [&](int i) {
    if (zones_[i] != ConeZone::top)
      jacobian_.addTransposed(i, y.data() + contactsWithRows_[i].row, tau);
  });
}

template <class Curvature>
void EllipticContact::addCurvature(Curvature& P) {
  forEachContact(selection, [&](int i) {
    double force[EllipticCone::kMaxDim], H[EllipticCone::kMaxDim * EllipticCone::kMaxDim];
    ConeZone zone;
    evaluate(i, x.data() + contactsWithRows_[i].row, force, H, zone);
    if (zone != ConeZone::top) jacobian_.addCurvature(i, H, P);
  });
}

void EllipticContact::addRow(int row, double scale, VectorX& y) const {
  const int i = contactOfRow_[row];
  FrameVector frame{};
  frame[row - contactsWithRows_[i].row] = scale;
  jacobian_.addTransposed(i, frame.data(), y);
}

void EllipticContact::findCrossings(int kind, std::vector<Crossing>& crossings) const {
  for (std::size_t i = 0; i < contactsWithRows_.size(); ++i) {
    if (placed_[i]) continue;
    const EllipticCone& cone = cones_[i];
    const double *from = x.data() + contactsWithRows_[i].row,
                 *rate = dx.data() + contactsWithRows_[i].row;
    // N(α) = n₀ + n₁ α,  T(α)² = t₀ + 2 t₁ α + t₂ α².
    const double n0 = cone.mu * from[0], n1 = cone.mu * rate[0];
    double t0 = 0.0, t1 = 0.0, t2 = 0.0;
    for (int k = 1; k < cone.dim; ++k) {
      const double U = cone.friction[k - 1] * from[k], dU = cone.friction[k - 1] * rate[k];
      t0 += U * U, t1 += U * dU, t2 += dU * dU;
    }
    for (const int breakpoint : {0, 1}) {
      // χ = 0 where N = −T/μ̂, φ = 0 where N = μ̂ T: the same quadratic with slope², and a sign.
      const double slope = breakpoint == 0 ? -1.0 / cone.mu : cone.mu;
      const double a = n1 * n1 - slope * slope * t2, b = n0 * n1 - slope * slope * t1;
      const double c = n0 * n0 - slope * slope * t0, discriminant = b * b - a * c;
      if (!(discriminant >= 0.0)) continue;
      const double q = -(b + std::copysign(std::sqrt(discriminant), b));
      for (const double alpha : {q / a, c / q}) {
        if (!(alpha >= 0.0 && alpha < kInfinity)) continue;
        const double N = n0 + alpha * n1,
                     T = std::sqrt(std::max(0.0, t0 + alpha * (2.0 * t1 + alpha * t2)));
        if (N * slope < 0.0 || T == 0.0) continue;  // the other nappe
        const double dT = (t1 + alpha * t2) / T;
        const double above = breakpoint == 0 ? cone.mu * n1 + dT : n1 - cone.mu * dT;
        const double jump = curvatureJump(contactsWithRows_[i].row, breakpoint);
        crossings.push_back({alpha,
                             above > 0.0 ? jump : -jump,
                             above,
                             {{kind, contactsWithRows_[i].row}, breakpoint}});
      }
    }
  }
}

double EllipticContact::aboveBreakpoint(int row, int breakpoint) const {
  const EllipticCone& cone = cones_[contactOfRow_[row]];
  return EllipticCone::aboveBreakpoint(cone.point(x.data() + row), breakpoint);
}

double EllipticContact::curvatureJump(int row, int) const {
  return -cones_[contactOfRow_[row]].stiffness();
}

ContactBlocks::FrameVector EllipticContact::breakpointInFrame(int row, int breakpoint) const {
  const EllipticCone& cone = cones_[contactOfRow_[row]];
  FrameVector gradient{};
  cone.breakpointGradient(cone.point(x.data() + row), breakpoint, gradient.data());
  return gradient;
}

void EllipticContact::addBreakpointGradient(int row, int breakpoint, double scale,
                                            VectorX& y) const {
  FrameVector gradient = breakpointInFrame(row, breakpoint);
  for (double& entry : gradient) entry *= scale;
  jacobian_.addTransposed(contactOfRow_[row], gradient.data(), y);
}

void EllipticContact::placeAtBreakpoint(int row, int breakpoint, bool stiffSide) {
  const int i = contactOfRow_[row];
  zones_[i] = static_cast<ConeZone>(stiffSide ? breakpoint : breakpoint + 1);
  placed_[i] = true;
}

using Numbers = std::vector<double>;
template void EllipticContact::multiply(const VectorX&, Numbers&) const;
template void EllipticContact::multiply(const BodyMotion&, Numbers&) const;
template void EllipticContact::addTransposed(const Numbers&, VectorX&) const;
template void EllipticContact::addTransposed(const Numbers&, BodyForce&) const;
template void EllipticContact::addCurvature(TreeMatrix&);
template void EllipticContact::addCurvature(ArticulatedFactor&);

}  // namespace softgauss
