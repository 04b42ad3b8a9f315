// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/constraints/body_rows.hpp"

#include "softgauss/engine/core/six_vectors.hpp"

namespace softgauss {

void BodyRows::clear() {
  blocks_.clear();
  W_.clear();
}

void BodyRows::add(const Model& model, const Kinematics& k, const RelativeMotion& m) {
  Block block;
  block.dim = m.linearDim + m.angularDim;
  // A body moves against itself only where the points are apart: then A has no rows of its own.
  const bool alone = m.bodyA == m.bodyB;
  block.bodyA = alone ? 0 : m.bodyA;
  block.bodyB = m.bodyB;
  if (block.bodyA != 0) block.WA = addBody(model, k, m.bodyA, -1.0, m.p_WA, m);
  if (block.bodyB != 0) block.WB = addBody(model, k, m.bodyB, 1.0, m.p_WB, m);
  if (alone && block.bodyB != 0) {
    const std::size_t WA = addBody(model, k, m.bodyA, -1.0, m.p_WA, m);
    for (std::size_t i = 0; i < idx(kSixRow * block.dim); ++i) W_[block.WB + i] += W_[WA + i];
    W_.resize(WA);
  }
  blocks_.push_back(block);
}

std::size_t BodyRows::addBody(const Model& model, const Kinematics& k, int body, double sign,
                              const Vector3& p_W, const RelativeMotion& m) {
  const std::size_t first = W_.size();
  W_.resize(first + idx(kSixRow * (m.linearDim + m.angularDim)));
  double* W = W_.data() + first;
  const Vector3 r = p_W - k.p_WO[idx(model.bodies[idx(body)].tree)];
  for (int d = 0; d < m.linearDim; ++d, W += kSixRow) {
    const Vector3 force = sign * m.linear.col(d), moment = r.cross(force);
    for (int i = 0; i < 3; ++i) W[i] = moment[i], W[3 + i] = force[i];
  }
  for (int d = 0; d < m.angularDim; ++d, W += kSixRow)
    for (int i = 0; i < 3; ++i) W[i] = sign * m.angular(i, d);
  return first;
}

void BodyRows::multiply(int i, const std::vector<Motion>& A, double* y) const {
  const Block& block = blocks_[idx(i)];
  const double *WA = W_.data() + block.WA, *WB = W_.data() + block.WB;
  for (int d = 0; d < block.dim; ++d) {
    double sum = 0.0;
    if (block.bodyB != 0) sum += dotSix(WB + kSixRow * d, numbers(A[idx(block.bodyB)]));
    if (block.bodyA != 0) sum += dotSix(WA + kSixRow * d, numbers(A[idx(block.bodyA)]));
    y[d] = sum;
  }
}

void BodyRows::addTransposed(int i, const double* f, std::vector<Force>& F) const {
  const Block& block = blocks_[idx(i)];
  const double *WA = W_.data() + block.WA, *WB = W_.data() + block.WB;
  for (int d = 0; d < block.dim; ++d) {
    if (f[d] == 0.0) continue;
    if (block.bodyB != 0) addSix(f[d], WB + kSixRow * d, numbers(F[idx(block.bodyB)]));
    if (block.bodyA != 0) addSix(f[d], WA + kSixRow * d, numbers(F[idx(block.bodyA)]));
  }
}

void BodyRows::addCurvature(int i, const double* H, ArticulatedFactor& P) const {
  const Block& block = blocks_[idx(i)];
  P.addRows({block.bodyA, block.bodyB, block.dim, W_.data() + block.WA, W_.data() + block.WB}, H);
}

void BodyRows::appendPairs(std::vector<std::pair<int, int>>& pairs) const {
  for (const Block& block : blocks_)
    if (block.bodyA != 0 && block.bodyB != 0) pairs.emplace_back(block.bodyA, block.bodyB);
}

}  // namespace softgauss
