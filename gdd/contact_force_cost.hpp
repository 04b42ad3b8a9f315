// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The part of ℓ that goals put on contact forces, which are no free variables: f = −∇s(J a −
/// a_ref).
///
///   ℓ_f(a) = Σ_j ½ w_j |e_j|²,     e_j = Σ_i C_ji F_i(a) − y_j                              (9.19)
/// F_i: force and moment of contact i in its frame (6), C_ji: (3 × 6), y_j: what is wished. With
/// H_i = ∇²s of the contact and J_i its Jacobian, ∂F_i/∂a = −H_i J_i, so
///   ∇ℓ_f = −Σ_i J_iᵀH_i π_i,    π_i = ∂ℓ_f/∂F_i = Σ_j w_j C_jiᵀ e_j
///   ∇²ℓ_f = Σ_j w_j G_jᵀG_j,    G_j = ∂e_j/∂a = −Σ_i C_ji H_i J_i                           (9.20)
/// With pyramidal cones H is constant in a cell: there e is affine and this is exact. e, and with
/// it π, is continuous from cell to cell; G is not. Elliptic cones bend F: there ∇²ℓ_f is
/// Gauss–Newton's, without the terms of ∂H/∂a.

#include <vector>

#include "softgauss/engine/step/data.hpp"

namespace softgauss::gdd {

/// Residuals of contact forces, as goals write them. Empty unless a goal is about forces.
class ContactForceCost {
 public:
  using Map = Eigen::Matrix<double, 3, 6>;
  struct Residual {
    double weight = 0.0;  ///< w
    Vector3 target;       ///< y
  };
  struct Part {
    int residual = 0;
    Cone cone{};      ///< the kind of contact,
    int contact = 0;  ///< and its place among those of its kind
    Map map;          ///< C
  };

  void clear() {
    residuals_.clear();
    parts_.clear();
    pending_ = false;
  }
  bool empty() const { return residuals_.empty(); }
  /// Makes room for so many contacts.
  void reserve(int contacts) {
    if (!empty()) parts_.reserve(residuals_.size() * static_cast<std::size_t>(contacts));
  }
  /// ½ weight |Σ C F − target|², with contacts that addContact() names afterwards. Without any it
  /// is a constant, and left out.
  void add(double weight, const Vector3& target) {
    next_ = {weight, target};
    pending_ = true;
  }
  /// A contact of the residual added last.
  void addContact(Cone cone, int contact, const Map& C) {
    if (pending_) residuals_.push_back(next_);
    pending_ = false;
    parts_.push_back({static_cast<int>(residuals_.size()) - 1, cone, contact, C});
  }

  const std::vector<Residual>& residuals() const { return residuals_; }
  const std::vector<Part>& parts() const { return parts_; }

 private:
  std::vector<Residual> residuals_;
  std::vector<Part> parts_;
  Residual next_;
  bool pending_ = false;  ///< next_ has no contact yet
};

/// ℓ_f where a solver is: e, its rate along a ray, its Jacobian in a cell. Without a cost, or with
/// an empty one, it is zero and costs nothing.
class ContactForceTerms {
 public:
  /// Takes the cost of this solve; forget() takes none.
  void setCost(const ContactForceCost& cost);
  void forget() { cost_ = nullptr; }
  bool active() const { return cost_ != nullptr; }

  // ---- at a point: the rows' forces must be evaluated there
  // --------------------------------------
  void evaluate(const Constraints& rows);  ///< e
  double value() const;                    ///< ℓ_f
  /// g ← g + ∇ℓ_f.
  void addGradient(const Constraints& rows, VectorX& g) const;
  /// ∂ℓ_f/∂f of the row of a breakpoint, or of what takes its place on a cone.
  double pull(Breakpoint breakpoint, const Constraints& rows) const;

  // ---- along a ray: Constraints::setRay(), setForceRate()
  // ----------------------------------------
  void setRate(const Constraints& rows);  ///< ė
  double slope() const;
  double curvature() const;
  void advance(double length);  ///< e ← e + length · ė
  /// ė past a breakpoint.
  void cross(const Crossing& crossing, const Constraints& rows);

  // ---- in a cell
  // ---------------------------------------------------------------------------------
  void setJacobian(const Constraints& rows, int dofs);  ///< G
  /// H ← H + ∇²ℓ_f; H holds every pair of dofs.
  void addCurvature(TreeMatrix& H) const;
  /// K ← K + Sᵀ∇²ℓ_f S, lower triangle.
  void addReducedCurvature(const RowMajorMatrixX& S, MatrixX& K);

 private:
  template <class F>
  void visitParts(const Constraints& rows, F&& f) const;

  const ContactForceCost* cost_ = nullptr;
  std::vector<Vector3> error_, rate_;  ///< e, ė
  std::vector<VectorX> jacobian_;      ///< three rows of G for each residual; keeps its memory
  VectorX reduced_;
};

}  // namespace softgauss::gdd
