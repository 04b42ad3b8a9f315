// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Bilateral rows that are the rows of Jacobian blocks, three to a block: what connections and
/// welds share.

#include <cstddef>
#include <utility>
#include <vector>

#include "engine/constraints/block_jacobian.hpp"
#include "engine/constraints/rows.hpp"

namespace softgauss {

/// A distance of three components and how it changes:
///   a_ref = −b J v − k d r − ((1 − lag b) J̇ v − b ahead)                                 (T.116)
struct Offset {
  Vector3 r;                        ///< [m]
  Vector3 rate;                     ///< J v [m/s]
  Vector3 bias;                     ///< J̇ v, or by how r has come and would go on [m/s²]
  double lag = 0.0;                 ///< how far v lies behind [s]
  Vector3 ahead = Vector3::Zero();  ///< J v less by how r has come, where no lag tells [m/s]
};

class BlockRows : public ScalarRows<Quadratic> {
 public:
  void multiply(const VectorX& a, std::vector<double>& y) const {
    for (int i = 0; i < jacobian_.size(); ++i) jacobian_.multiply(i, a, y.data() + 3 * i);
  }
  void addTransposed(const std::vector<double>& y, VectorX& tau) const {
    for (int i = 0; i < jacobian_.size(); ++i) jacobian_.addTransposed(i, y.data() + 3 * i, tau);
  }
  void addCurvature(TreeMatrix& P) {
    for (int i = 0; i < jacobian_.size(); ++i) {
      const double* d = h.data() + 3 * i;
      const double H[9] = {d[0], 0.0, 0.0, 0.0, d[1], 0.0, 0.0, 0.0, d[2]};
      jacobian_.addCurvature(i, H, P);
    }
  }
  /// y ← y + scale · (row i of J)ᵀ.
  void addRow(int i, double scale, VectorX& y) const {
    double rows[3] = {0.0, 0.0, 0.0};
    rows[i % 3] = scale;
    jacobian_.addTransposed(i / 3, rows, y);
  }
  void appendCouplings(std::vector<Segment>& segments, std::vector<int>& setEnd) const {
    jacobian_.appendCouplings(segments, setEnd);
  }

  /// Leaves out of the references what they have of the bodies' turning, in the blocks that concern
  /// a body: a_ref = −b J v − k d r.
  template <class Concerns>
  void leaveOutTurning(const Concerns& concerns) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (!concerns(bodies_[i].first) && !concerns(bodies_[i].second)) continue;
      for (std::size_t row = 3 * i; row < 3 * i + 3; ++row) reference[row] += turning_[row];
    }
  }

  std::size_t bytes() const {
    return ScalarRows::bytes() + jacobian_.bytes() + bytesOfAll(turning_, bodies_);
  }

 protected:
  void clearBlocks() {
    jacobian_.clear();
    clearRows();
    turning_.clear();
    bodies_.clear();
  }
  /// The three rows of the last block added, which is between the bodies of `motion`.
  void pushRows(const RelativeMotion& motion, const Offset& offset, const Softness& softness) {
    for (int i = 0; i < 3; ++i) {
      const double b = softness.damping;
      turning_.push_back((1.0 - offset.lag * b) * offset.bias[i] - b * offset.ahead[i]);
      reference.push_back(softness.referenceAcceleration(offset.rate[i], offset.r[i]) -
                          turning_.back());
      pushSoftness(softness);
    }
    bodies_.emplace_back(motion.bodyA, motion.bodyB);
  }

  BlockJacobian jacobian_;

 private:
  std::vector<double> turning_;              ///< what each reference has of the bodies' turning
  std::vector<std::pair<int, int>> bodies_;  ///< of each block
};

}  // namespace softgauss
