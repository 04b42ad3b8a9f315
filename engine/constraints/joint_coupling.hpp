// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Joint couplings: the coordinate of one scalar joint is a polynomial p of that of another (mimic
/// joints, gears), or a constant. One row each.
///
/// Distance r = q_f − p(q_l), so J = e_fᵀ − p′(q_l) e_lᵀ:
///   x = J a − a_ref,   a_ref = −b J v − k d(|r|) r − (1 − lag b) J̇ v,   J̇ v = −p″ v_l²
///   s(x) = ½ D x²,   A = min(w_f + p′² w_l, 1/L)                                          (4.6)
///   L = max(m_f, 3000/(1/m_f + p′²/m_l)),   m_f = M_ff,   m_l = M_ll                       (4.6)
/// with the lag of (4.5). A coupling carries its follower, and what presses its joints against
/// each other, motors and what is gripped, of which no inertia tells: gear teeth hold three
/// thousand times what moves them. Without a leader, tied to the world, L = m_f. What bounces
/// carries nothing. In MuJoCo's model A = w_f + w_l.

#include <vector>

#include "softgauss/engine/constraints/assembly.hpp"
#include "softgauss/engine/constraints/rows.hpp"
#include "softgauss/engine/dynamics/articulated_factor.hpp"
#include "softgauss/engine/dynamics/body_motion.hpp"

namespace softgauss {

class CouplingRows : public ScalarRows<Quadratic> {
 public:
  void assemble(const Assembly& in);
  void multiply(const VectorX& a, std::vector<double>& y) const;
  void addTransposed(const std::vector<double>& y, VectorX& tau) const;
  void multiply(const BodyMotion& a, std::vector<double>& y) const { multiply(a.joint, y); }
  void addTransposed(const std::vector<double>& y, BodyForce& tau) const {
    addTransposed(y, tau.joint);
  }
  void addCurvature(TreeMatrix& P);
  void addCurvature(ArticulatedFactor& P);
  /// y ← y + scale · (row i of J)ᵀ.
  void addRow(int i, double scale, VectorX& y) const;
  /// Pairs of dofs on different branches.
  void appendCouplings(std::vector<Segment>& segments, std::vector<int>& setEnd) const;

  /// Appends the pairs of bodies whose joints rows couple.
  void appendCoupledBodies(const Model& model, std::vector<std::pair<int, int>>& pairs) const;
  /// A body that the row moves.
  int bodyOf(const Model& model, int row) const {
    return model.dofs[idx(pairs_[idx(row)].follower)].body;
  }

  std::size_t bytes() const { return ScalarRows::bytes() + bytesOf(pairs_); }

 private:
  struct Pair {
    int follower = 0;      ///< dof
    int leader = 0;        ///< dof; the follower's own without a leader
    double slope = 0.0;    ///< p′, 0 without a leader
    double bend = 0.0;     ///< p″, 0 where it has no part
    bool couples = false;  ///< neither dof moves the other's body
  };
  std::vector<Pair> pairs_;
};

}  // namespace softgauss
