// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The engine at the knots of a plan: inverse dynamics, its derivatives, the exact step (23).
///
/// A plan steps barely (StepDerivative::bareStep()): then (q, v) is the whole state but for what
/// slides, which looks at the acceleration of the step before, and g(q, v, a) = M̂ a + c + Jᵀ∇s at
/// q_m. Control acts on every tree.

#include <memory>

#include "softgauss/engine/step/contact_source.hpp"
#include "softgauss/engine/step/inverse_derivative.hpp"
#include "softgauss/engine/step/transition.hpp"

namespace softgauss::planning {

/// An instant of a plan.
struct Knot {
  Knot(const Model& model, const Transition& step);
  void copyState(const Knot& from) {
    q = from.q, v = from.v, last = from.last, hasLast = from.hasLast;
  }

  VectorX q, v;    ///< state
  VectorX last;    ///< a of the step that has ended here, where hasLast: State::a
  VectorX a, tau;  ///< acceleration of the step from here, and the force g(q, v, a) that it takes
  MatrixX G;       ///< ∂g/∂(q, v) (nv × 2 nv)
  MatrixX P;       ///< ∂g/∂a (nv × nv)
  Transition transition;
  bool hasLast = false;
};

/// One a thread (knot_threads.hpp).
class PlanDynamics {
 public:
  /// `model` has the options of a bare step; `contacts` may be null. Both must outlive this.
  PlanDynamics(const Model& model, ContactSource* contacts);

  /// The model's mechanisms or contacts have changed; `contacts` find the new ones.
  void restart(ContactSource* contacts);

  const Model& model;
  Data& data() { return *data_; }
  State middle;  ///< where the stages are: (q_m, v)
  const Input& input() const { return input_; }

  /// Stages of the step from the knot's state.
  SolveStatus stages(const Knot& knot);
  /// knot.tau ← g(q, v, a).
  SolveStatus inverse(Knot& knot);
  /// G, P and the transition; knot.tau too, unless it is kept.
  SolveStatus linearise(Knot& knot, bool keepsForce = false);
  /// a of (1.1) under data().forces.tau ← tau, from the stages; `guess` may be null.
  SolveStatus forward(const VectorX& tau, const VectorX* guess);
  /// Sets the state of `next` to that in which the step from `knot` by its a ends.
  void move(const Knot& knot, Knot& next) const;
  const Transition& step() const { return step_; }

 private:
  std::unique_ptr<Data> data_;
  ContactSource* contacts_;
  Input input_;
  Transition step_;
  InverseDerivative derivative_;
};

}  // namespace softgauss::planning
