// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Rows as forces on bodies: what a block measures of the motion of two bodies, without dofs.
///
///   y = W_B A_B + W_A A_A,    forces Wᵀ f on the bodies,    curvatures Wᵀ H W of
///   articulated_factor.hpp
/// For a linear row along t at a point p of body B, W = (r × t, t) with r from O of the body's tree
/// to p; for an angular row, W = (t, 0); for body A the same with the opposite sign.

#include <span>
#include <utility>
#include <vector>

#include "softgauss/engine/core/memory.hpp"
#include "softgauss/engine/dynamics/articulated_factor.hpp"
#include "softgauss/engine/dynamics/body_motion.hpp"

namespace softgauss {

/// What a block measures of the motion of body B as seen from body A: first the velocity of a point
/// of B less that of a point of A, along columns of `linear`, then the relative angular velocity,
/// along columns of `angular`; world axes.
struct RelativeMotion {
  int bodyA = 0, bodyB = 0;
  Vector3 p_WA = Vector3::Zero();  ///< the point of A
  Vector3 p_WB = Vector3::Zero();  ///< the point of B
  Matrix3 linear = Matrix3::Identity();
  int linearDim = 0;  ///< columns used
  Matrix3 angular = Matrix3::Identity();
  int angularDim = 0;
};

class BodyRows {
 public:
  void clear();
  void add(const Model& model, const Kinematics& k, const RelativeMotion& motion);
  int size() const { return static_cast<int>(blocks_.size()); }
  /// A body that block i moves.
  int bodyOf(int i) const {
    const Block& block = blocks_[idx(i)];
    return block.bodyB != 0 ? block.bodyB : block.bodyA;
  }

  /// y ← W A of block i.
  void multiply(int i, const std::vector<Motion>& A, double* y) const;
  /// F ← F + Wᵀ f of block i.
  void addTransposed(int i, const double* f, std::vector<Force>& F) const;
  /// P ← P + Jᵀ H J of block i, for a symmetric H.
  void addCurvature(int i, const double* H, ArticulatedFactor& P) const;
  /// Appends the pairs of bodies that rows couple.
  void appendPairs(std::vector<std::pair<int, int>>& pairs) const;

  std::size_t bytes() const { return bytesOfAll(blocks_, W_); }

 private:
  struct Block {
    int bodyA = 0, bodyB = 0;  ///< the world where it has no part
    int dim = 0;
    std::size_t WA = 0, WB = 0;  ///< first numbers in W_
  };
  /// `dim` rows of one of the bodies.
  std::size_t addBody(const Model& model, const Kinematics& k, int body, double sign,
                      const Vector3& p_W, const RelativeMotion& motion);

  std::vector<Block> blocks_;
  std::vector<double> W_;
};

}  // namespace softgauss
