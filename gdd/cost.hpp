// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The cost ℓ(a) that goals put on the acceleration, equation (8) of the paper.
///
/// Goals write residuals; ℓ is their weighted sum (9.1):
///   ℓ(a) = Σ ½ w |J a − y|²  +  ½ aᵀD a + aᵀe  +  ½ m aᵀM a + aᵀM o
/// Rows may be one-sided, ½ w max(0, y − J a)² (9.22): each counts or does not, as chooseSides()
/// has it.
/// J: rows of a Jacobian block or any other rows, y: wished value less the bias J̇ v; D, e: of
/// single dofs, D diagonal; m, o: the terms of virtual damping,
/// ½ α (a + βv)ᵀM(a + βv) = ½ α aᵀMa + α β aᵀM v + const.
///
/// Functions that are no such sum enter by expansions of second order
/// (sequential_quadratic_solve.hpp). The control cost, ½ gᵀ(R + W) g, is no function of a alone: R
/// is given, goals add W (control_cost_term.hpp). What goals want of contact forces is kept apart
/// (contact_force_cost.hpp): value(), gradient() and the curvatures here are without it.
///
/// ℓ is a sum over islands of trees that its terms, or rows, couple, and may be that of one of them
/// alone: select().
///
/// Nothing here allocates in steady state, but what is for functions does.

#include <Eigen/Cholesky>
#include <functional>
#include <vector>

#include "softgauss/engine/constraints/block_jacobian.hpp"
#include "softgauss/engine/constraints/row_selection.hpp"
#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/dynamics/centroidal.hpp"
#include "softgauss/engine/dynamics/tree_islands.hpp"
#include "softgauss/gdd/contact_force_cost.hpp"
#include "softgauss/gdd/control_cost_term.hpp"

namespace softgauss::gdd {

/// Matrices for goals to work in while they add their cost. They keep their memory from step to
/// step, so that the step allocates nothing; what one goal leaves in them says nothing to the next.
struct GoalWorkspace {
  using Rows = Eigen::Matrix<double, 6, Eigen::Dynamic>;
  Rows J, half, rows;  ///< (6 × nv)
  VectorX dofs;        ///< (nv)
  TreeFactor massFactor;
  Centroidal centroidal;
  // Of a posture that yields to k rows of places:
  MatrixX placeRows, placeHalf;  ///< (nv × k)
  MatrixX placeInertia;          ///< (k × k)
  VectorX placePull;             ///< (k)
  double placeShare = 1.0;       ///< how far it yields to them
  Eigen::LLT<MatrixX> placeFactor;
  VectorX pull;  ///< (nv)

  explicit GoalWorkspace(int n) : J(6, n), half(6, n), rows(6, n), dofs(n), pull(n) {}
};

class GoalCost {
 public:
  explicit GoalCost(int dofs)
      : dofWeight_(VectorX::Zero(dofs)),
        dofOffset_(VectorX::Zero(dofs)),
        controlCost_(dofs),
        metricSlope_(VectorX::Zero(dofs)),
        allDofs_{0, dofs},
        addedDofs_{allDofs_},
        scratch_(VectorX::Zero(dofs)),
        workspace_(dofs) {}

  /// Returns φ(a) and writes ∇φ (nv) and ∇²φ (nv × nv), which have their size.
  using Function = std::function<double(const VectorX& a, VectorX& gradient, MatrixX& hessian)>;

  /// Makes room for one-sided terms of all joints, and for so many contacts in terms of forces.
  void reserve(int controls, int contacts);
  /// No goals; force costs ½ gᵀR g.
  void clear(const ForceMetric& R = {}) { clear(R, {&allDofs_, 1}); }
  /// The same where goals are of these dofs alone, of whole trees.
  void clear(const ForceMetric& R, Segments dofs);
  /// From here on weights of rows, dofs and metric count so many times; 1 after clear().
  void setShare(double share) { share_ = share; }
  /// ½ weight |J a − target|² for the world acceleration J a of the point p_WP of `body`.
  void addPoint(const Model& model, const Kinematics& k, const TreeSparsity& tree, int body,
                const Vector3& p_WP, double weight, const Vector3& target);
  /// ½ weight |J a − target|² for any rows J (k × nv).
  void addRows(const Eigen::Ref<const MatrixX>& J, double weight,
               const Eigen::Ref<const VectorX>& target);
  /// ½ weight max(0, least − J a)² for one row J (nv). It does not count before chooseSides().
  void addOneSided(const VectorX& J, double weight, double least);
  /// The same of one dof: J a = sign a_dof.
  void addOneSided(int dof, double sign, double weight, double least);
  bool hasSides() const { return !sides_.empty(); }
  /// From here on those one-sided rows count that are short of their least at a, and ℓ is (9.22)
  /// there; with `first` no more than one row changes. Returns whether any has.
  bool chooseSides(const VectorX& a, bool first = false);
  /// ½ weight (a_dof − target)², up to a constant.
  void addDof(int dof, double weight, double target);
  /// ½ weight (a − target)ᵀ M (a − target), up to a constant.
  template <class Target>
  void addMetric(double weight, const TreeMatrix& M, const Eigen::MatrixBase<Target>& target) {
    metricWeight_ += share_ * weight;
    for (const Segment s : addedDofs_)
      part(workspace_.dofs, s) = -share_ * weight * target.segment(s.begin, s.end - s.begin);
    M.multiply(addedDofs_, workspace_.dofs, scratch_);
    for (const Segment s : addedDofs_) part(metricSlope_, s) += part(scratch_, s);
  }

  /// The control cost counts from `force` (nv) [N, N m], not from 0.
  void setFreeControl(const VectorX& force) { controlCost_.setFree(force); }
  /// ½ weight g_dof².
  void addControlCost(int dof, double weight) { controlCost_.add(dof, weight); }
  /// ½ weight (c·g)².
  void addControlCost(const Eigen::Ref<const VectorX>& c, double weight) {
    controlCost_.add(c, weight);
  }
  /// φ(a).
  void addFunction(Function function) { functions_.push_back(std::move(function)); }

  /// What goals want of contact forces.
  ContactForceCost& forces() { return forces_; }
  const ContactForceCost& forces() const { return forcesCount_ ? forces_ : kNoForces; }

  /// Appends pairs of bodies whose trees its terms couple: functions all, contact forces those of
  /// all contacts that they are of.
  void appendPairs(const Model& model, const Constraints& rows,
                   std::vector<std::pair<int, int>>& pairs) const;
  /// Finds the terms of each of these islands, none of which a term couples with another; they must
  /// stay.
  void divide(const Model& model, const Constraints& rows, const TreeIslands& islands);
  /// From here on ℓ is that of one island, until clear(); −1: of all. Vectors that come out are
  /// zero elsewhere.
  void select(int island);

  GoalWorkspace& workspace() { return workspace_; }
  double metricWeight() const { return metricWeight_; }
  const ControlCostTerm& controlCost() const { return controlCost_; }  ///< R + W
  /// For a factor of the M in R.
  void prepareControlCost(const TreeFactor& massFactor) { controlCost_.prepare(massFactor); }

  bool hasFunctions() const { return !functions_.empty(); }
  /// From here on the functions count as their expansion m about a (9.18). Returns false when it is
  /// not finite.
  bool expand(const TreeMatrix& M, const VectorX& a, double mu);
  double expansionStart() const { return hasFunctions() ? expansionStart_ : 0.0; }  ///< φ there
  double expansionValue(const VectorX& a) const;                                    ///< m(a)
  VectorX expansionGradient(const VectorX& a) const;                                ///< ∇m(a)
  double functionValue(const VectorX& a);                                           ///< φ(a)
  /// φ(a); writes ∇φ (nv) and ∇²φ (nv × nv).
  double functions(const VectorX& a, VectorX& gradient, MatrixX& hessian);
  /// H ← H with its eigenvalues against M that are below −0.9 σ raised to that. Where R is M⁻¹,
  /// σ = 1; else σ ≤ 1 is the largest number with R ⪰ σ M⁻¹, so that P R P ⪰ σ P M⁻¹P ⪰ σ M.
  void raiseCurvature(const TreeMatrix& M, MatrixX& H) const;
  /// max |∇φ − ∇m|ᵢ scaleᵢ over max(1, max |∇φ|ᵢ scaleᵢ) at a.
  double expansionError(const VectorX& a, const VectorX& scale);

  /// ∇ℓ at a; Ma = M a.
  void gradient(const VectorX& a, const VectorX& Ma, VectorX& g) const;
  /// ℓ(a) up to its constant.
  double value(const VectorX& a, const VectorX& Ma) const;
  /// Hd ← ∇²ℓ d; Md = M d.
  void multiplyCurvature(const VectorX& d, const VectorX& Md, VectorX& Hd) const;
  /// dᵀ∇²ℓ d; Md = M d.
  double curvatureAlong(const VectorX& d, const VectorX& Md) const;
  /// H ← H + ∇²ℓ without the metric part m M; H holds every pair of dofs.
  void addRowCurvature(TreeMatrix& H);
  /// The same without functions.
  void addQuadraticCurvature(TreeMatrix& H);
  /// K ← K + Sᵀ∇²ℓ S, lower triangle, for S (nv × a multiple of four). `massFactor` is of M, rootS
  /// scratch of the size of S.
  void addReducedCurvature(const TreeFactor& massFactor, const RowMajorMatrixX& S,
                           RowMajorMatrixX& rootS, MatrixX& K) const;

 private:
  struct OneSided {
    std::size_t row;  ///< of dense_
    double weight;    ///< while it counts; else denseWeight_ is 0
    int dof = -1;     ///< that alone is in the row, times `sign`; −1: any
    double sign = 0.0;
  };
  OneSided& addSide(double weight, double least);
  /// What is selected.
  Segments dofs() const { return island_ < 0 ? Segments(&allDofs_, 1) : islands_->dofs(island_); }
  /// f(i) of each block of points, and of each dense row, a std::size_t, that is selected.
  template <class F>
  void forEachPoint(F&& f) const {
    forEach(points_, rows_.size(), f);
  }
  template <class F>
  void forEachRow(F&& f) const {
    forEach(denseRows_, static_cast<int>(denseWeight_.size()), f);
  }
  template <class F>
  void forEach(const SegmentSets& sets, int count, F&& f) const {
    const Segment all{0, count};
    for (const Segment s : island_ < 0 ? Segments(&all, 1) : sets[island_])
      for (std::size_t i = idx(s.begin); i < idx(s.end); ++i) f(i);
  }

  static inline const ContactForceCost kNoForces;

  double share_ = 1.0;
  BlockJacobian rows_;
  std::vector<double> weight_;  ///< one a block
  std::vector<Vector3> target_;
  MatrixX dense_;  ///< (nv × room) one column a row of J; the first denseWeight_.size() are in use
  std::vector<double> denseWeight_;
  std::vector<double> denseTarget_;
  std::vector<OneSided> sides_;
  VectorX dofWeight_;            ///< D
  VectorX dofOffset_;            ///< e
  ControlCostTerm controlCost_;  ///< R + W
  ContactForceCost forces_;
  std::vector<Function> functions_;
  VectorX expandedAt_, expansionSlope_;  ///< a_k, ∇φ(a_k)
  MatrixX expansionCurvature_;           ///< [∇²φ] + μ M
  double expansionStart_ = 0.0;          ///< φ(a_k)
  double metricWeight_ = 0.0;            ///< m
  VectorX metricSlope_;                  ///< M o
  Segment allDofs_;
  std::vector<Segment> addedDofs_;  ///< of which goals are
  int island_ = -1;                 ///< that is selected
  const TreeIslands* islands_ = nullptr;
  SegmentSets points_, denseRows_;  ///< of each island
  int forcesIsland_ = -1;
  bool forcesCount_ = true;
  mutable VectorX scratch_, reduced_;
  GoalWorkspace workspace_;
};

}  // namespace softgauss::gdd
