// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/no_slip_friction.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss {

// Both take V = −D U in F, and leave its projection there; H (n × n) becomes −∂F/∂U, and the
// result is the potential: F·(V − ½ F)/D.

double NoSlipFriction::Patch::roundFriction(double* F, double* H, int& piece) const {
  const int n = dim - 1;
  double squares = 0.0;
  for (int k = 0; k < n; ++k) squares += F[k] * F[k];
  const double length = std::sqrt(squares);
  if (length <= bound) {
    piece = 0;
    for (int k = 0; H && k < n; ++k) H[k * (n + 1)] = D;
    return 0.5 * squares / D;
  }
  piece = -1;
  const double shrink = bound / length;
  for (int k = 0; H && k < n; ++k)
    for (int l = 0; l < n; ++l)
      H[k * n + l] = D * shrink * ((k == l ? 1.0 : 0.0) - F[k] * F[l] / squares);
  for (int k = 0; k < n; ++k) F[k] *= shrink;
  return bound * (length - 0.5 * bound) / D;
}

double NoSlipFriction::Patch::edgedFriction(double* F, double* H, int& piece) const {
  const int n = dim - 1;
  double size[5], sum = 0.0;
  for (int k = 0; k < n; ++k) sum += size[k] = std::abs(F[k]);
  // All entries are shortened by the least θ that brings their sum down to the bound.
  double theta = 0.0;
  if (!(sum <= bound)) {
    std::sort(size, size + n, std::greater<>());
    double partial = 0.0;
    for (int k = 0; k < n; ++k) {
      partial += size[k];
      const double next = (partial - bound) / (k + 1);
      if (k > 0 && size[k] <= next) break;
      theta = next;
    }
  }
  double potential = 0.0;
  int active = 0;
  piece = theta > 0.0 ? 1 : 0;
  double sign[5];
  for (int k = 0; k < n; ++k) {
    const double V = F[k], shortened = std::abs(V) - theta;
    sign[k] = shortened > 0.0 || theta == 0.0 ? (V < 0.0 ? -1.0 : 1.0) : 0.0;
    F[k] = std::isnan(V) ? V : sign[k] * shortened;
    potential += F[k] * (V - 0.5 * F[k]) / D;
    active += sign[k] != 0.0;
    piece = 3 * piece + static_cast<int>(theta > 0.0 ? sign[k] + 1.0 : 0.0);
  }
  if (!H) return potential;
  for (int k = 0; k < n; ++k)
    for (int l = 0; l < n; ++l)
      H[k * n + l] =
          sign[k] == 0.0 || sign[l] == 0.0
              ? 0.0
              : D * ((k == l ? 1.0 : 0.0) - (theta > 0.0 ? sign[k] * sign[l] / active : 0.0));
  return potential;
}

double NoSlipFriction::Patch::at(const double* at, double* force, double* H, int& piece) const {
  const int n = dim - 1;
  if (H) std::fill_n(H, dim * dim, 0.0);
  const Jet normal = HalfQuadratic{Dn}.at(at[0]);
  force[0] = -normal.slope;
  if (H) H[0] = normal.curvature;
  double F[5], inner[25] = {};
  for (int k = 0; k < n; ++k) F[k] = -D * friction[k] * at[k + 1];
  double cost = normal.value;
  piece = 0;
  if (n > 0)
    cost += round ? roundFriction(F, H ? inner : nullptr, piece)
                  : edgedFriction(F, H ? inner : nullptr, piece);
  for (int k = 0; k < n; ++k) {
    force[k + 1] = friction[k] * F[k];
    for (int l = 0; H && l < n; ++l)
      H[(k + 1) * dim + l + 1] = friction[k] * friction[l] * inner[k * n + l];
  }
  if (piece >= 0) piece = 2 * piece + (normal.curvature > 0.0 ? 1 : 0);
  return cost;
}

void NoSlipFriction::clear() {
  patches_.clear();
  for (std::vector<double>* column : {&reference, &x, &dx, &f}) column->clear();
}

void NoSlipFriction::add(Patch patch, const VectorX& a, const double* aRef, int stride) {
  patch.row = static_cast<int>(reference.size());
  ContactBlocks::FrameVector y{};
  patch.contacts->jacobian().multiply(patch.contact, a, y.data());
  reference.push_back(y[0] + patch.bound / patch.Dn);
  for (int k = 0; k + 1 < patch.dim; ++k)
    reference.push_back(stride == 1 ? aRef[k + 1]
                                    : (aRef[2 * k] - aRef[2 * k + 1]) / (2.0 * patch.friction[k]));
  patches_.push_back(patch);
}

bool NoSlipFriction::take(PyramidalContact& pyramids, EllipticContact& cones, const VectorX& a) {
  clear();
  bool rubs = false;
  for (int i = 0; i < static_cast<int>(pyramids.contactsWithRows().size()); ++i) {
    const ContactRows& made = pyramids.contactsWithRows()[i];
    const auto row = static_cast<std::size_t>(made.row);
    Patch patch{&pyramids, i, made.frictionDim + 1};
    patch.friction = made.friction;
    patch.bound = pyramids.frameForce(i)[0];
    patch.Dn = std::max(1, 2 * made.frictionDim) * pyramids.D[row];
    patch.D = kStiffer * 2.0 * made.regularisationScale * pyramids.D[row] /
              made.loadStiffening;  // two edges a direction
    add(patch, a, pyramids.reference.data() + row, 2);
    rubs |= made.frictionDim > 0;
  }
  for (int i = 0; i < static_cast<int>(cones.contactsWithRows().size()); ++i) {
    const EllipticCone& cone = cones.cone(i);
    Patch patch{&cones, i, cone.dim};
    patch.friction = cone.friction;
    patch.bound = cones.frameForce(i)[0];
    patch.Dn = cone.D;
    const ContactRows& made = cones.contactsWithRows()[i];
    patch.D =
        kStiffer * made.regularisationScale * cone.D / (cone.mu * cone.mu * made.loadStiffening);
    patch.round = true;
    add(patch, a, cones.reference.data() + cones.contactsWithRows()[i].row, 1);
    rubs = true;
  }
  for (std::vector<double>* column : {&x, &dx, &f}) column->assign(reference.size(), 0.0);
  pieces_.assign(patches_.size(), -2);
  return rubs;
}

void NoSlipFriction::multiply(const VectorX& a, std::vector<double>& y) const {
  for (const Patch& p : patches_) p.contacts->jacobian().multiply(p.contact, a, y.data() + p.row);
}

double NoSlipFriction::evaluate(bool& cellChanged) {
  double cost = 0.0;
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    const Patch& p = patches_[i];
    int piece = 0;
    cost += p.at(x.data() + p.row, f.data() + p.row, nullptr, piece);
    cellChanged |= piece < 0 || piece != pieces_[i];
    pieces_[i] = piece;
  }
  return cost;
}

void NoSlipFriction::along(double alpha, Jet& sum) const {
  for (const Patch& p : patches_) {
    double at[kMaxDim], force[kMaxDim], H[kMaxDim * kMaxDim];
    const double *from = x.data() + p.row, *rate = dx.data() + p.row;
    for (int k = 0; k < p.dim; ++k) at[k] = from[k] + alpha * rate[k];
    int piece = 0;
    sum.value += p.at(at, force, H, piece);
    for (int k = 0; k < p.dim; ++k) {
      sum.slope -= force[k] * rate[k];
      for (int l = 0; l < p.dim; ++l) sum.curvature += rate[k] * H[k * p.dim + l] * rate[l];
    }
  }
}

void NoSlipFriction::advance(double alpha) {
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += alpha * dx[i];
}

void NoSlipFriction::addForce(VectorX& tau) const {
  for (const Patch& p : patches_)
    p.contacts->jacobian().addTransposed(p.contact, f.data() + p.row, tau);
}

void NoSlipFriction::addCurvature(TreeMatrix& P) {
  for (const Patch& p : patches_) {
    double force[kMaxDim], H[kMaxDim * kMaxDim];
    int piece = 0;
    p.at(x.data() + p.row, force, H, piece);
    p.contacts->jacobian().addCurvature(p.contact, H, P);
  }
}

Vector3 NoSlipFriction::force(int i) const {
  const Patch& p = patches_[static_cast<std::size_t>(i)];
  ContactBlocks::FrameVector frame{};
  std::copy_n(f.data() + p.row, p.dim, frame.data());
  return p.contacts->linearInWorld(p.contact, frame);
}

}  // namespace softgauss
