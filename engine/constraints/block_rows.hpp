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

  /// Leaves J̇ v out of the references of the blocks that concern a body, until putBackBias().
  template <class Concerns>
  void leaveOutBias(const Concerns& concerns) {
    withBias_ = reference;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (!concerns(bodies_[i].first) && !concerns(bodies_[i].second)) continue;
      for (std::size_t row = 3 * i; row < 3 * i + 3; ++row) reference[row] += bias_[row];
    }
  }
  void putBackBias() { reference = withBias_; }

  std::size_t bytes() const {
    return ScalarRows::bytes() + jacobian_.bytes() + bytesOfAll(bias_, withBias_, bodies_);
  }

 protected:
  void clearBlocks() {
    jacobian_.clear();
    clearRows();
    bias_.clear();
    bodies_.clear();
  }
  /// The three rows of the last block added, which is between the bodies of `motion`: at distance
  /// r, J v and J̇ v, a_ref = −b (J v − lag J̇ v) − k d r − J̇ v.
  void pushRows(const RelativeMotion& motion, const Vector3& r, const Vector3& rate,
                const Vector3& bias, double lag, const Softness& softness) {
    const double share = 1.0 - lag * softness.damping;
    for (int i = 0; i < 3; ++i) {
      bias_.push_back(share * bias[i]);
      reference.push_back(softness.referenceAcceleration(rate[i], r[i]) - bias_.back());
      pushSoftness(softness);
    }
    bodies_.emplace_back(motion.bodyA, motion.bodyB);
  }

  BlockJacobian jacobian_;

 private:
  std::vector<double> bias_;                 ///< J̇ v in each reference
  std::vector<double> withBias_;             ///< references while some are without it
  std::vector<std::pair<int, int>> bodies_;  ///< of each block
};

}  // namespace softgauss
