// SPDX-License-Identifier: Apache-2.0
#pragma once

/// P⁻¹ in O(n + rows) without M, J or P: articulated-body elimination with rows.
///
/// P = M + Jᵀ H J is the curvature in the joint accelerations a of
///   Σ_b ½ A_bᵀ I_b A_b + ½ Σ_i d_i a_i² + Σ ½ yᵀ H y,     y = W_A A_A + W_B A_B
/// with A_b = A_parent + Σ S_i a_i, d_i what acts on joint i alone (armature, damping, limits, dry
/// friction), and y what rows see of two bodies. A row of one moving body adds Wᵀ H W to the body's
/// inertia; rows of two add K = W_Aᵀ H W_B beside both. Joint i is minimised out, leaves first:
///   U = I S,  D = Sᵀ U + d_i,  V_c = K_cᵀ S
///   I ← I − U Uᵀ/D,  K_c ← K_c − U V_cᵀ/D,  I_c ← I_c − V_c V_cᵀ/D,  K_ce ← K_ce − V_c V_eᵀ/D
/// for the bodies c, e that are coupled with the body, which then moves as its parent does: its
/// inertia and blocks pass to the parent. Without couplings this is the articulated-body algorithm
/// (Featherstone, Rigid Body Dynamics Algorithms, 2008, section 7.3) of inertias that rows have
/// made stiffer; that soft equality rows of one body come in so is known from constrained
/// articulated-body algorithms (Sathya and Carpentier, 2025). Here the rows' law is one-sided, has
/// knees or bends, and Newton's method asks for P⁻¹ of each of its cells.
///
/// Rows C of two joints anywhere, of curvature H, come in afterwards, by Woodbury's formula:
///   P⁻¹ b = x₀ − X (H⁻¹ + C X)⁻¹ C x₀,     x₀ = P₀⁻¹ b,   X = P₀⁻¹ Cᵀ

#include <Eigen/Cholesky>
#include <vector>

#include "softgauss/engine/dynamics/elimination_order.hpp"
#include "softgauss/engine/dynamics/inertia.hpp"

namespace softgauss {

/// What rows see of two bodies: y = W_A A_A + W_B A_B, `dim` six-vectors each, in rows of eight
/// (six_vectors.hpp). A body that is the world has no part in it.
struct BodyPair {
  int bodyA = 0, bodyB = 0;
  int dim = 0;
  const double* WA = nullptr;
  const double* WB = nullptr;
};

/// A row of two joints: y = a_first − slope a_second.
struct JointPair {
  int first = 0, second = 0;  ///< dofs
  double slope = 0.0;
};

class ArticulatedFactor {
 public:
  ArticulatedFactor() = default;
  explicit ArticulatedFactor(const Model& model);

  /// Rows of these pairs of bodies may come, see EliminationOrder::find(); of none without this.
  void couple(std::vector<std::pair<int, int>>& pairs) { order_.find(pairs); }
  /// The same, and each of `islands` is factored by itself.
  void couple(std::vector<std::pair<int, int>>& pairs, const TreeIslands& islands) {
    order_.find(pairs, &islands);
  }

  /// Begins anew with the inertias of the bodies, and the armature and MassMatrix::added of the
  /// joints. What is added then counts `rowScale` times.
  void begin(const Model& model, const MassMatrix& inertia, double rowScale = 1.0);
  /// The same of these bodies, of whole trees, where no rows are of two bodies: to them all that
  /// follows is confined.
  void begin(const Model& model, const MassMatrix& inertia, Segments bodies);
  /// The same of one island.
  void begin(const Model& model, const MassMatrix& inertia, const TreeIslands& islands, int island,
             double rowScale = 1.0);
  /// Adds h to the diagonal of joint i.
  void addJoint(int i, double h) { diagonal_[idx(i)] += rowScale_ * h; }
  /// Joint i does not move: x_i is 0.
  void lock(int i) { diagonal_[idx(i)] = kInfinity; }
  /// Adds a row of two joints with curvature h > 0.
  void addJoints(const JointPair& pair, double h) {
    pairs_.push_back({pair, 1.0 / (rowScale_ * h)});
  }
  /// Adds rows of symmetric curvature H (dim × dim, row-major).
  void addRows(const BodyPair& pair, const double* H);
  /// False where a pivot is not positive, that of failedJoint().
  bool factor(const Model& model, const Kinematics& k);
  /// x ← P⁻¹ x, and the motions of the bodies by it; what is of other islands is left as it is.
  void solve(const Model& model, const Kinematics& k, VectorX& x, std::vector<Motion>& A);

  int failedJoint() const { return failedJoint_; }

 private:
  struct PairRow : JointPair {
    double inverseCurvature = 0.0;
    double of(const VectorX& x) const { return x[first] - slope * x[second]; }
  };
  void beginBodies(const Model& model, const MassMatrix& inertia, Segments bodies);
  void beginBlocks(const Model& model, Segment blocks);
  bool factorPairs(const Model& model, const Kinematics& k);
  void solveTree(const Model& model, const Kinematics& k, VectorX& x, std::vector<Motion>& A);

  EliminationOrder order_;
  std::vector<Segment> steps_;   ///< of the order, that are taken
  std::vector<Segment> bodies_;  ///< theirs
  double rowScale_ = 1.0;
  int failedJoint_ = -1;
  std::vector<double> diagonal_;      ///< (nv) d
  std::vector<double> inertia_;       ///< (bodies × 48) I, then those of articulated bodies
  std::vector<double> block_;         ///< (blocks × 48) K
  std::vector<double> U_;             ///< (nv × 8)
  std::vector<double> V_;             ///< (8 of each coupling of a body and joint of it)
  std::vector<double> inversePivot_;  ///< (nv) 1/D
  std::vector<int> firstV_;           ///< (bodies) where those of a body begin
  std::vector<double> u_;             ///< (nv) scratch of solve()
  std::vector<Force> p_;              ///< (bodies) scratch of solve()

  std::vector<PairRow> pairs_;      ///< C, H⁻¹
  MatrixX X_, S_;                   ///< (nv × pairs), (pairs × pairs) H⁻¹ + C X
  Eigen::LLT<MatrixX> pairFactor_;  ///< of S
  VectorX x_, y_;                   ///< (nv), (pairs) scratch
  std::vector<Motion> motions_;     ///< (bodies) scratch
};

}  // namespace softgauss
