// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/elliptic_contact.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss {

void EllipticContact::assemble(const Assembly& in) {
  const Options& options = in.model.options;
  clearBlocks();
  cones_.clear();
  reference.clear();
  if (options.cone == Cone::elliptic) {
    for (int i = 0; i < in.contacts.size(); ++i) {
      const std::optional<Touch> touch = touchAt(in, i);
      if (!touch || touch->frictionDim == 0) continue;
      const FrameVector velocity = addBlock(in, i, *touch, static_cast<int>(reference.size()));
      const Softness& soft = touch->softness;
      cones_.push_back({touch->frictionDim + 1, 1.0 / soft.R,
                        touch->mu() / std::sqrt(options.impedanceRatio), touch->friction});
      reference.push_back(soft.referenceAcceleration(velocity[0], touch->distance));
      for (int k = 1; k <= touch->frictionDim; ++k)
        reference.push_back(soft.referenceAcceleration(velocity[k], 0.0));
    }
  }
  for (std::vector<double>* column : {&x, &dx, &f}) column->resize(reference.size());
  zones_.resize(cones_.size());
  indexRows(reference.size());
}

void EllipticContact::multiply(const VectorX& a, std::vector<double>& y) const {
  for (std::size_t i = 0; i < made_.size(); ++i)
    jacobian_.multiply(static_cast<int>(i), a, y.data() + made_[i].row);
}

double EllipticContact::evaluate(bool& cellChanged) {
  double cost = 0.0;
  for (std::size_t i = 0; i < made_.size(); ++i) {
    ConeZone zone;
    cost += cones_[i].at(x.data() + made_[i].row, f.data() + made_[i].row, nullptr, zone);
    // The middle zone is curved: there the curvature changes with every step.
    cellChanged |= zone != zones_[i] || zone == ConeZone::middle;
    zones_[i] = zone;
  }
  return cost;
}

void EllipticContact::along(double alpha, Jet& sum) const {
  for (std::size_t i = 0; i < made_.size(); ++i) {
    const int dim = cones_[i].dim;
    const double *from = x.data() + made_[i].row, *rate = dx.data() + made_[i].row;
    double at[EllipticCone::kMaxDim], force[EllipticCone::kMaxDim];
    double H[EllipticCone::kMaxDim * EllipticCone::kMaxDim];
    for (int k = 0; k < dim; ++k) at[k] = from[k] + alpha * rate[k];
    ConeZone zone;
    sum.value += cones_[i].at(at, force, H, zone);
    if (zone == ConeZone::top) continue;
    for (int k = 0; k < dim; ++k) {
      sum.slope -= force[k] * rate[k];
      for (int l = 0; l < dim; ++l) sum.curvature += rate[k] * H[k * dim + l] * rate[l];
    }
  }
}

void EllipticContact::advance(double alpha) {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += alpha * dx[i];
}

ContactBlocks::FrameVector EllipticContact::frameForce(int i) const {
  FrameVector frame{};
  std::copy_n(f.data() + made_[i].row, cones_[i].dim, frame.data());
  return frame;
}

void EllipticContact::addForce(VectorX& tau) const {
  for (int i = 0; i < static_cast<int>(made_.size()); ++i) {
    const double* frame = f.data() + made_[i].row;
    if (frame[0] != 0.0) jacobian_.addTransposed(i, frame, tau);
  }
}

void EllipticContact::addCurvature(TreeMatrix& P) {
  for (std::size_t i = 0; i < made_.size(); ++i) {
    double force[EllipticCone::kMaxDim], H[EllipticCone::kMaxDim * EllipticCone::kMaxDim];
    ConeZone zone;
    cones_[i].at(x.data() + made_[i].row, force, H, zone);
    if (zone != ConeZone::top) jacobian_.addCurvature(static_cast<int>(i), H, P);
  }
}

void EllipticContact::addRow(int row, double scale, VectorX& y) const {
  const int i = contactOfRow_[row];
  FrameVector frame{};
  frame[row - made_[i].row] = scale;
  jacobian_.addTransposed(i, frame.data(), y);
}

}  // namespace softgauss
