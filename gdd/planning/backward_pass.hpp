// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Riccati's recursion over accelerations or over controls.
///
/// V_{t+1} ≈ v·e + ½ eᵀV e about the knot's state. With A, B of (P.1), G and P of the knot, and the
/// slope w and curvature W (diagonal) that force costs there,
///
///   Q_x = p_x + Aᵀv + Gᵀw,     Q_a = Bᵀv + P w
///   Q_xx = p_xx + AᵀVA + GᵀW G,   Q_ax = BᵀVA + P W G,   Q_aa = BᵀVB + P W P              (P.4)
///
/// That is the whole problem where accelerations are the controls. Where forces u on some dofs are,
/// and no other forces, δa = S δu + a_x δx with S = P⁻¹ on those dofs and a_x = −P⁻¹G, and with the
/// part F = (p, A, B, V) of Q that is not of forces
///
///   Q_uu = R + SᵀF_aa S,   Q_ux = Sᵀ(F_ax + F_aa a_x),   Q_u = R u + SᵀF_a
///   Q_xx = F_xx + F_axᵀa_x + a_xᵀF_ax + a_xᵀF_aa a_x,   Q_x = F_x + a_xᵀF_a                (P.5)
///
/// Of the control d = k + K δx that Q gives, with Q_uu raised by ρ diag(Q_uu) and within bounds,
/// V_t is what the Q that is not raised is worth. Nothing here allocates after construction.

#include "softgauss/gdd/planning/partial_minimum.hpp"
#include "softgauss/gdd/planning/plan_dynamics.hpp"

namespace softgauss::planning {

/// V of a knot: slope (2 nv) and curvature (2 nv × 2 nv).
struct ValueModel {
  VectorX slope;
  MatrixX curvature;
  explicit ValueModel(int dofs = 0)
      : slope(VectorX::Zero(2 * dofs)), curvature(MatrixX::Zero(2 * dofs, 2 * dofs)) {}
  /// Sets the upper triangle of the curvature from the lower one.
  void mirror();
};

/// A feedback law of a knot.
struct Feedback {
  VectorX k;         ///< (m)
  MatrixX K;         ///< (m × 2 nv)
  VectorX slope;     ///< Q_u (m)
  VectorX diagonal;  ///< of Q_uu (m)
  Feedback(int m, int dofs)
      : k(VectorX::Zero(m)), K(MatrixX::Zero(m, 2 * dofs)), slope(k), diagonal(k) {}
};

/// min ½ xᵀH x + gᵀx, lower ≤ x ≤ upper, by projected Newton (Tassa, Mansard and Todorov, 2014).
class BoxProgram {
 public:
  explicit BoxProgram(int m);
  /// From x, which is clamped; false where H is not positive definite on what is free.
  bool solve(const MatrixX& H, const VectorX& g, const VectorX& lower, const VectorX& upper,
             VectorX& x);
  const std::vector<int>& free() const { return free_; }
  /// K ← −H_ff⁻¹ X_f in the rows that are free, 0 in the others; X (m × any).
  void gain(const MatrixX& X, MatrixX& K);

 private:
  double valueAt(const MatrixX& H, const VectorX& g, const VectorX& x);
  bool factorize(const MatrixX& H);

  std::vector<int> free_, factored_;
  MatrixX L_;  ///< lower, of what is free
  VectorX gradient_, step_, trial_, Hx_;
  MatrixX rows_;
};

class BackwardPass {
 public:
  BackwardPass(const Model& model, std::vector<int> controlled);

  /// V_t and the feedback of the accelerations. `state`: slope and curvature (lower triangle) of
  /// what the knot's state costs; w, W (nv). False where Q_aa is not positive definite.
  bool overAccelerations(const Knot& knot, const ValueModel& next, const ValueModel& state,
                         const VectorX& w, const VectorX& W, double rho, Feedback& feedback,
                         ValueModel& value);
  /// The same of the forces on controlled dofs, with R (nv) and the bounds of u (nv).
  bool overControls(const Knot& knot, const ValueModel& next, const ValueModel& state,
                    const VectorX& R, const VectorX& lower, const VectorX& upper, double rho,
                    Feedback& feedback, ValueModel& value);
  /// Of the last pass, whose sums begin with begin(): J changes by α linear() + α² quadratic().
  void begin() { linear_ = quadratic_ = 0.0; }
  double linear() const { return linear_; }
  double quadratic() const { return quadratic_; }

 private:
  /// F of (P.5): Q without what forces cost.
  void withoutForces(const Knot& knot, const ValueModel& next, const ValueModel& state);
  /// a_x and S of (P.5); false where P is not positive definite.
  bool solveAccelerations(const Knot& knot);
  /// Q of (P.5) in overU_.
  void setControls(const Knot& knot, const VectorX& R);
  /// K, k and V_t of a function that is raised by raised_ on its diagonal.
  void setValue(PartialMinimum& minimum, double rho, Feedback& feedback, ValueModel& value);
  /// The same where some of k is at its bounds.
  bool setBoundedValue(Feedback& feedback, ValueModel& value);

  int n_;
  std::vector<int> controlled_;
  MatrixX VA_, VB_, Qaa_, Qxa_, Qxx_;
  VectorX Qa_, Qx_, Av_;
  PartialMinimum overA_, overU_;
  VectorX raised_;
  // Of (P.5), by rows of dofs: (P −G 1), (· a_x S), F_aa (a_x S), ½ F_aa a_x + F_ax with F_a
  // behind.
  DenseRows dynamics_, solved_, weighed_, half_;
  // Where bounds are active.
  MatrixX Quu_, raisedControls_, Qux_, QK_, KQK_;
  VectorX lower_, upper_, Qk_;
  BoxProgram box_;
  double linear_ = 0.0, quadratic_ = 0.0;
};

}  // namespace softgauss::planning
