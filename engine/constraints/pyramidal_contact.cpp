// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/pyramidal_contact.hpp"

#include <algorithm>

namespace softgauss {
namespace {

/// Values on the edges from those in the contact frame: e = y_n ± μ_k y_k. Without friction the one
/// row is y_n.
void toEdges(const double* y, int frictionDim, const std::array<double, 5>& mu, double* e) {
  if (frictionDim == 0) e[0] = y[0];
  for (int k = 0; k < frictionDim; ++k) {
    e[2 * k] = y[0] + mu[k] * y[k + 1];
    e[2 * k + 1] = y[0] - mu[k] * y[k + 1];
  }
}

}  // namespace

void PyramidalContact::begin() {
  clearBlocks();
  clearRows();
}

void PyramidalContact::add(const Assembly& in, int i, const PairSurface& pair, const Touch& touch) {
  const Options& options = in.model.options;
  if (touch.frictionDim > 0 && options.cone != Cone::pyramidal) return;
  const BlockMotion moves = addBlock(in, i, pair, touch, static_cast<int>(reference.size()));
  double velocity[10], bias[10];
  toEdges(moves.velocity.data(), touch.frictionDim, touch.friction, velocity);
  toEdges(moves.bias.data(), touch.frictionDim, touch.friction, bias);
  const int edges = std::max(1, 2 * touch.frictionDim);
  Softness soft = soften(in, touch, moves.velocity);
  double asks[10];
  for (int edge = 0; edge < edges; ++edge)
    asks[edge] = soft.referenceAcceleration(velocity[edge], touch.distance);
  if (touch.frictionDim > 0 && options.correctsSlip())
    soft = soft.hardened(levelPyramid(slipOf(in, touch, soft, moves),
                                      soft.referenceAcceleration(moves.velocity[0], touch.distance),
                                      asks));
  for (int edge = 0; edge < edges; ++edge) asks[edge] -= bias[edge];
  pushRows(soft, asks, static_cast<std::size_t>(edges));
}

void PyramidalContact::finish() {
  resizeRows(reference.size());
  indexRows(reference.size());
}

void PyramidalContact::assemble(const Assembly& in) {
  begin();
  PairSurface pair;
  for (int i = 0; i < in.contacts.size(); ++i)
    if (const std::optional<Touch> touch = touchAt(in, i, pair)) add(in, i, pair, *touch);
  finish();
}

template <class Acceleration>
void PyramidalContact::multiply(const Acceleration& a, std::vector<double>& y) const {
  forEachContact(selection, [&](int i) {
    double frame[6];
    jacobian_.multiply(i, a, frame);
    toEdges(frame, contactsWithRows_[i].frictionDim, contactsWithRows_[i].friction,
            y.data() + contactsWithRows_[i].row);
  });
}

ContactBlocks::FrameVector PyramidalContact::inFrame(int i, const std::vector<double>& y) const {
  const double* e = y.data() + contactsWithRows_[i].row;
  const ContactRows& made = contactsWithRows_[i];
  FrameVector frame{};
  if (made.frictionDim == 0) frame[0] = e[0];
  for (int k = 0; k < made.frictionDim; ++k) {
    frame[0] = frame[0] + e[2 * k] + e[2 * k + 1];
    frame[k + 1] = made.friction[k] * (e[2 * k] - e[2 * k + 1]);
  }
  return frame;
}

template <class Forces>
void PyramidalContact::addTransposed(const std::vector<double>& y, Forces& tau) const {
  forEachContact(selection, [&](int i) {
    const FrameVector frame = inFrame(i, y);
    if (frame != FrameVector{}) jacobian_.addTransposed(i, frame.data(), tau);
  });
}

int PyramidalContact::frameCurvature(int i, double* H) const {
  const double* e = h.data() + contactsWithRows_[i].row;
  const int pairs = contactsWithRows_[i].frictionDim, dim = pairs + 1;
  if (pairs == 0) {
    H[0] = e[0];
    return 1;
  }
  // Σ over edges of D (1, ±μ_k e_k)(1, ±μ_k e_k)ᵀ.
  std::fill_n(H, dim * dim, 0.0);
  for (int k = 0; k < pairs; ++k) {
    const double mu = contactsWithRows_[i].friction[k], sum = e[2 * k] + e[2 * k + 1];
    H[0] = H[0] + e[2 * k] + e[2 * k + 1];
    H[k + 1] = H[(k + 1) * dim] = mu * (e[2 * k] - e[2 * k + 1]);
    H[(k + 1) * dim + k + 1] = mu * mu * sum;
  }
  return dim;
}

template <class Curvature>
void PyramidalContact::addCurvature(Curvature& P) {
  double H[36];
  forEachContact(selection, [&](int i) {
    frameCurvature(i, H);
    if (H[0] != 0.0) jacobian_.addCurvature(i, H, P);
  });
}

ContactBlocks::FrameVector PyramidalContact::rowInFrame(int row, double scale) const {
  const ContactRows& made = contactsWithRows_[contactOfRow_[row]];
  const int edge = row - made.row;
  FrameVector frame = {scale};
  if (made.frictionDim > 0)
    frame[1 + edge / 2] = scale * (edge % 2 == 0 ? 1.0 : -1.0) * made.friction[edge / 2];
  return frame;
}

ContactBlocks::FrameVector PyramidalContact::breakpointInFrame(int row, int) const {
  return rowInFrame(row, 1.0);
}

void PyramidalContact::addRow(int row, double scale, VectorX& y) const {
  jacobian_.addTransposed(contactOfRow_[row], rowInFrame(row, scale).data(), y);
}

using Numbers = std::vector<double>;
template void PyramidalContact::multiply(const VectorX&, Numbers&) const;
template void PyramidalContact::multiply(const BodyMotion&, Numbers&) const;
template void PyramidalContact::addTransposed(const Numbers&, VectorX&) const;
template void PyramidalContact::addTransposed(const Numbers&, BodyForce&) const;
template void PyramidalContact::addCurvature(TreeMatrix&);
template void PyramidalContact::addCurvature(ArticulatedFactor&);

}  // namespace softgauss
