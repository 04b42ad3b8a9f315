// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a plan costs: a sum over its knots, and at its end,
///
///   J = Σ_t h [p(q_t, v_t) + ½ τ_tᵀR τ_t] + p_N(q_N, v_N)                                  (P.3)
///
/// Where a plan that has moved on keeps its end, the knots from the end of the first one on have
/// h p_N too: what was to be reached by then is to be kept.
///
/// p and p_N are sums of terms ½ rᵀW r of residuals r(q, v), W diagonal. Their models are those of
/// Gauss and Newton: slope Jᵀ W r and curvature Jᵀ W J, J by the tangent of q and by v, so that no
/// curvature is negative.

#include <memory>
#include <vector>

#include "softgauss/engine/dynamics/inertia.hpp"

namespace softgauss::planning {

/// A knot's state as a cost sees it.
struct KnotView {
  const Model& model;
  const VectorX& q;
  const VectorX& v;
  int knot = 0;                            ///< 0 … N, and by how many the plan has moved on
  const Kinematics* kinematics = nullptr;  ///< at q and v, where the term asks for them
};

class CostTerm {
 public:
  virtual ~CostTerm() = default;
  virtual bool needsKinematics() const { return false; }
  /// The term's cost.
  virtual double value(const KnotView& at) = 0;
  /// The same; adds scale times its slope (2 nv) and curvature (2 nv × 2 nv, lower triangle).
  virtual double expand(const KnotView& at, double scale, VectorX& slope, MatrixX& curvature) = 0;
};

/// ½ eᵀ diag(w) e of e = (q ⊖ q*, v − v*).
class StateCost final : public CostTerm {
 public:
  VectorX positionWeight;  ///< (nv) [1/m², 1/rad²]
  VectorX velocityWeight;  ///< (nv)
  /// q* (nq) and v* (nv): one for all knots, or one for each.
  std::vector<VectorX> q, v;

  /// Rest at q, nothing weighed.
  StateCost(const Model& model, const VectorX& q);
  double value(const KnotView& at) override;
  double expand(const KnotView& at, double scale, VectorX& slope, MatrixX& curvature) override;

 private:
  void setError(const KnotView& at);
  VectorX e_;           ///< (2 nv)
  VectorX difference_;  ///< (nv)
};

/// A term of rows r with weights w.
class ResidualCost : public CostTerm {
 public:
  double value(const KnotView& at) final;
  double expand(const KnotView& at, double scale, VectorX& slope, MatrixX& curvature) final;

 protected:
  /// r; and unless null its Jacobian (rows × 2 nv).
  virtual void evaluate(const KnotView& at, VectorX& r, MatrixX* J) = 0;
  VectorX weight_;  ///< (rows)

 private:
  VectorX r_;
  MatrixX J_, WJ_;
};

/// ½ w |p − p*|² + ½ w_v |ṗ|² of a point of a frame, world axes.
class PointCost final : public ResidualCost {
 public:
  PointCost(const Model& model, const std::string& frame, const Vector3& p_FP,
            const Vector3& target_W, double weight, double velocityWeight = 0.0);
  bool needsKinematics() const override { return true; }

 private:
  void evaluate(const KnotView& at, VectorX& r, MatrixX* J) override;
  int frame_;
  Vector3 p_FP_, target_;
};

/// ½ w |log(R*ᵀ R)|² of a frame's orientation.
class OrientationCost final : public ResidualCost {
 public:
  OrientationCost(const Model& model, const std::string& frame, const Matrix3& target,
                  double weight);
  bool needsKinematics() const override { return true; }

 private:
  void evaluate(const KnotView& at, VectorX& r, MatrixX* J) override;
  int frame_;
  Matrix3 target_;
};

/// ½ w_c |c − c*|² + ½ w_p |p − p*|² + ½ w_L |L|² of all that moves: centre of mass, momentum and
/// angular momentum about it, world axes.
class CentroidalCost final : public ResidualCost {
 public:
  explicit CentroidalCost(const Model& model);
  void centre(const Vector3& target, double weight);    ///< [m]
  void momentum(const Vector3& target, double weight);  ///< [kg m/s]
  void angularMomentum(double weight);                  ///< [kg m²/s]
  bool needsKinematics() const override { return true; }

 private:
  void evaluate(const KnotView& at, VectorX& r, MatrixX* J) override;
  void addColumns(const KnotView& at, const Vector3& c, const Vector3& p, MatrixX& J);
  double mass_;
  Vector3 centre_ = Vector3::Zero(), momentum_ = Vector3::Zero();
  std::vector<Inertia> inertia_;
  std::vector<Force> h_;  ///< momenta of subtrees
};

/// All terms of a plan.
struct PlanCost {
  std::vector<std::unique_ptr<CostTerm>> running;  ///< counted h times at every knot but the last
  std::vector<std::unique_ptr<CostTerm>> final;
  VectorX effort;  ///< R (nv) of actuated dofs [1/(N² s), 1/(N² m² s)]
  bool keepsEnd = false;
  int passed = 0;  ///< knots by which the plan has moved on: targets of running terms go on by them
};

}  // namespace softgauss::planning
