// SPDX-License-Identifier: Apache-2.0
#include "engine/constraints/sticking_friction.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss {

double StickingFriction::Patch::at(const double* at, double* force, double* H, bool& sticks) const {
  if (H) std::fill_n(H, dim * dim, 0.0);
  sticks = true;
  if (round) return atRound(at, force, H, sticks);
  double cost = 0.0;
  for (int k = 0; k < dim; ++k) {
    const Jet s = limit[k] > 0.0 ? Huber{D[k], limit[k]}.at(at[k]) : Jet{};
    cost += s.value;
    force[k] = -s.slope;
    if (H) H[k * (dim + 1)] = s.curvature;
    sticks = sticks && s.curvature > 0.0;
  }
  return cost;
}

double StickingFriction::Patch::atRound(const double* at, double* force, double* H,
                                        bool& sticks) const {
  const double stiffness = dim > 0 ? D[0] / (friction[0] * friction[0]) : 0.0;  // D_k/μ_k²
  double u[5], squares = 0.0;
  for (int k = 0; k < dim; ++k) {
    u[k] = friction[k] * at[k];
    squares += u[k] * u[k];
  }
  const double T = std::sqrt(squares);
  sticks = stiffness * T < normal;
  if (sticks) {
    for (int k = 0; k < dim; ++k) {
      force[k] = -stiffness * friction[k] * u[k];
      if (H) H[k * (dim + 1)] = D[k];
    }
    return 0.5 * stiffness * squares;
  }
  for (int k = 0; k < dim; ++k) u[k] = T == 0.0 ? 0.0 : u[k] / T;  // NaN stays NaN
  for (int k = 0; k < dim; ++k) {
    force[k] = -normal * friction[k] * u[k];
    if (!H || T == 0.0) continue;
    for (int l = 0; l < dim; ++l)
      H[k * dim + l] =
          normal / T * friction[k] * friction[l] * ((k == l ? 1.0 : 0.0) - u[k] * u[l]);
  }
  return stiffness > 0.0 ? normal * (T - 0.5 * normal / stiffness) : 0.0;
}

ContactBlocks::FrameVector StickingFriction::Patch::inFrame(double first, const double* y) const {
  ContactBlocks::FrameVector frame{first};
  std::copy_n(y + row, dim, frame.data() + 1);
  return frame;
}

void StickingFriction::clear() {
  patches_.clear();
  for (std::vector<double>* column : {&reference, &x, &dx, &f}) column->clear();
}

bool StickingFriction::take(PyramidalContact& pyramids, EllipticContact& cones) {
  clear();
  for (int i = 0; i < static_cast<int>(pyramids.made().size()); ++i) {
    const ContactRows& made = pyramids.made()[i];
    Patch patch{&pyramids, i, made.frictionDim, static_cast<int>(reference.size())};
    patch.normal = pyramids.frameForce(i)[0];
    patch.friction = made.friction;
    for (int k = 0; k < made.frictionDim; ++k) {
      const auto edge = static_cast<std::size_t>(made.row + 2 * k);
      const double mu = made.friction[k];
      patch.D[k] = kStiffer * 2.0 * mu * mu * pyramids.D[edge];
      patch.limit[k] = mu * pyramids.edgeSum(i, k);
      reference.push_back((pyramids.reference[edge] - pyramids.reference[edge + 1]) / (2.0 * mu));
    }
    patches_.push_back(patch);
  }
  for (int i = 0; i < static_cast<int>(cones.made().size()); ++i) {
    const ContactRows& made = cones.made()[i];
    const EllipticCone& cone = cones.cone(i);
    Patch patch{&cones, i, made.frictionDim, static_cast<int>(reference.size())};
    patch.normal = cones.frameForce(i)[0];
    patch.round = true;
    patch.friction = made.friction;
    for (int k = 0; k < made.frictionDim; ++k) {
      patch.D[k] = kStiffer * cone.D * made.friction[k] * made.friction[k] / (cone.mu * cone.mu);
      reference.push_back(cones.reference[static_cast<std::size_t>(made.row + 1 + k)]);
    }
    patches_.push_back(patch);
  }
  for (std::vector<double>* column : {&x, &dx, &f}) column->assign(reference.size(), 0.0);
  sticks_.assign(patches_.size(), false);
  return !reference.empty();
}

void StickingFriction::addNormalForce(VectorX& tau) const {
  for (const Patch& p : patches_) {
    const ContactBlocks::FrameVector frame{p.normal};
    if (p.normal != 0.0) p.contacts->jacobian().addTransposed(p.contact, frame.data(), tau);
  }
}

void StickingFriction::multiply(const VectorX& a, std::vector<double>& y) const {
  for (const Patch& p : patches_) {
    ContactBlocks::FrameVector frame;
    p.contacts->jacobian().multiply(p.contact, a, frame.data());
    std::copy_n(frame.data() + 1, p.dim, y.data() + p.row);
  }
}

double StickingFriction::evaluate(bool& cellChanged) {
  double cost = 0.0;
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    const Patch& p = patches_[i];
    bool sticks = false;
    cost += p.at(x.data() + p.row, f.data() + p.row, nullptr, sticks);
    // Where a direction slides, or a cone bends, the curvature may have changed.
    cellChanged |= !sticks || !sticks_[i];
    sticks_[i] = sticks;
  }
  return cost;
}

void StickingFriction::along(double alpha, Jet& sum) const {
  for (const Patch& p : patches_) {
    double at[5], force[5], H[25];
    bool sticks = false;
    const double* rate = dx.data() + p.row;
    for (int k = 0; k < p.dim; ++k)
      at[k] = x[static_cast<std::size_t>(p.row + k)] + alpha * rate[k];
    sum.value += p.at(at, force, H, sticks);
    for (int k = 0; k < p.dim; ++k) {
      sum.slope -= force[k] * rate[k];
      for (int l = 0; l < p.dim; ++l) sum.curvature += rate[k] * H[k * p.dim + l] * rate[l];
    }
  }
}

void StickingFriction::advance(double alpha) {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += alpha * dx[i];
}

void StickingFriction::addForce(VectorX& tau) const {
  for (const Patch& p : patches_) {
    const ContactBlocks::FrameVector frame = p.inFrame(0.0, f.data());
    if (p.dim > 0) p.contacts->jacobian().addTransposed(p.contact, frame.data(), tau);
  }
}

void StickingFriction::addCurvature(TreeMatrix& P) {
  for (const Patch& p : patches_) {
    if (p.dim == 0) continue;
    double force[5], H[25], inBlock[36] = {};
    bool sticks = false;
    p.at(x.data() + p.row, force, H, sticks);
    for (int k = 0; k < p.dim; ++k)
      std::copy_n(H + k * p.dim, p.dim, inBlock + (k + 1) * (p.dim + 1) + 1);
    p.contacts->jacobian().addCurvature(p.contact, inBlock, P);
  }
}

Vector3 StickingFriction::force(int i) const {
  const Patch& p = patches_[static_cast<std::size_t>(i)];
  return p.contacts->linearInWorld(p.contact, p.inFrame(p.normal, f.data()));
}

}  // namespace softgauss
