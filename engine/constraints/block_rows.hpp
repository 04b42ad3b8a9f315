// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Bilateral rows that are the rows of Jacobian blocks, three to a block: what connections and
/// welds share.

#include <cstddef>
#include <vector>

#include "softgauss/engine/constraints/block_jacobian.hpp"
#include "softgauss/engine/constraints/rows.hpp"

namespace softgauss {

/// A distance of three components and how it changes:
///   a_ref = −b (J v − lag J̇ v) − k d r − J̇ v                                              (4.5)
struct Offset {
  Vector3 r;     ///< [m]
  Vector3 rate;  ///< where the step begins, J v − lag J̇ v [m/s]
  Vector3 bias;  ///< J̇ v [m/s²]
};

class BlockRows : public ScalarRows<Quadratic> {
 public:
  /// `Acceleration`, `Forces`, `Curvature`: as BlockJacobian takes them.
  template <class Acceleration>
  void multiply(const Acceleration& a, std::vector<double>& y) const {
    forEachBlock([&](int i) { jacobian_.multiply(i, a, y.data() + 3 * i); });
  }
  template <class Forces>
  void addTransposed(const std::vector<double>& y, Forces& tau) const {
    forEachBlock([&](int i) { jacobian_.addTransposed(i, y.data() + 3 * i, tau); });
  }
  template <class Curvature>
  void addCurvature(Curvature& P) {
    forEachBlock([&](int i) {
      const double* d = h.data() + 3 * i;
      const double H[9] = {d[0], 0.0, 0.0, 0.0, d[1], 0.0, 0.0, 0.0, d[2]};
      jacobian_.addCurvature(i, H, P);
    });
  }
  /// y ← y + scale · (row i of J)ᵀ.
  void addRow(int i, double scale, VectorX& y) const {
    double rows[3] = {0.0, 0.0, 0.0};
    rows[i % 3] = scale;
    jacobian_.addTransposed(i / 3, rows, y);
  }
  void reserveColumns() { jacobian_.reserveColumns(); }
  void addColumns(const Model& model, const Kinematics& k, const TreeSparsity& tree) {
    forEachBlock([&](int i) { jacobian_.addColumns(model, k, tree, i); });
  }
  void appendCouplings(std::vector<Segment>& segments, std::vector<int>& setEnd) const {
    jacobian_.appendCouplings(segments, setEnd);
  }
  void appendPairs(std::vector<std::pair<int, int>>& pairs) const { jacobian_.appendPairs(pairs); }
  /// A body that the row moves.
  int bodyOf(const Model&, int row) const { return jacobian_.bodyOf(row / 3); }

  std::size_t bytes() const { return ScalarRows::bytes() + jacobian_.bytes(); }

 protected:
  void clearBlocks() {
    jacobian_.clear();
    clearRows();
  }
  /// The three rows of the last block added.
  void pushRows(const Offset& offset, const Softness& softness) {
    for (int i = 0; i < 3; ++i) {
      reference.push_back(softness.referenceAcceleration(offset.rate[i], offset.r[i]) -
                          offset.bias[i]);
      pushSoftness(softness);
    }
  }

  BlockJacobian jacobian_;

 private:
  template <class F>
  void forEachBlock(F&& call) const {
    for (const Segment rows : selection.segments())
      for (int i = rows.begin / 3; i < rows.end / 3; ++i) call(i);
  }
};

}  // namespace softgauss
