// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Goal directed dynamics: a step whose control is found from goals (figure 1 of the paper).
///
/// Solve (8.1) for the acceleration that the goals want and the actuators can cause; clamp the
/// control to its limits; run forward dynamics from that acceleration; integrate. Solver 2 ends
/// on the physics: it clamps nothing, and forward dynamics has nothing left to do.

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "softgauss/engine/step/step.hpp"
#include "softgauss/gdd/active_set.hpp"
#include "softgauss/gdd/augmented_lagrangian.hpp"
#include "softgauss/gdd/goal.hpp"
#include "softgauss/gdd/gravity_compensation.hpp"
#include "softgauss/gdd/island_solutions.hpp"
#include "softgauss/gdd/motion_limits.hpp"
#include "softgauss/gdd/one_sided_solve.hpp"
#include "softgauss/gdd/sequential_quadratic_solve.hpp"

namespace softgauss::gdd {

enum class GddSolver {
  augmentedLagrangian,  ///< solver 1, over accelerations
  activeSet             ///< solver 2, over controls; where contacts have elliptic cones, solver 1
};

/// From where the control cost counts.
enum class ControlCost {
  aboutGravity,  ///< what holds the robot at rest against gravity: the price pulls nowhere then
  total          ///< zero, as in the paper
};

/// Goals, solver and memory of a controlled simulation. One a thread.
class GoalDirectedController final : public StepControl {
 public:
  explicit GoalDirectedController(const Model& model);

  std::vector<std::unique_ptr<Goal>> goals;
  ControlLimits limits;  ///< what the actuators can do; change it, or give them gears and couplings
  /// Keeps velocity limits and slows down ahead of range ends; absent, goals alone decide.
  std::optional<MotionLimits> motionLimits;
  ForceMetric forceMetric;  ///< R, M⁻¹ unless set
  ControlCost controlCost = ControlCost::aboutGravity;
  GddSolver solver = GddSolver::activeSet;
  AugmentedLagrangian augmentedLagrangian;
  ActiveSet activeSet;
  SequentialQuadraticSolve expansion;  ///< for goals that are not quadratic
  /// Iterations of the solver, at most, for one control: past them the best control that was found
  /// is taken, with GddStatus::iterationLimit and its certificate.
  int iterationBudget = std::numeric_limits<int>::max();
  /// The same in wall time [s], looked at once an iteration: what is past it is less than one
  /// iteration. With a finite one results depend on the machine.
  double timeBudget = kInfinity;

  VectorX control;  ///< τ = B u of the last step, 0 on unactuated dofs (nv) [N or N m]
  VectorX
      commands;  ///< u of the last step, of the actuators of limits.transmission, in their order
  GddReport report;  ///< of the last step; of a step in parts the worst of them, counts are sums
  double solveTime = 0.0;  ///< wall time of the last step's GDD solves [s], where Data::timed

  /// Motion limits, origin of the price, solvers with their options and budget of another one;
  /// goals, limits and forceMetric, which are of a model's dofs, stay.
  void takeSettings(const GoalDirectedController& from);

  /// Marks the trees that it controls in Input::controlled. Solver 1 squares P, and is given soft
  /// contacts.
  void markControlled(const Model& model, std::vector<std::uint8_t>& trees) const {
    const bool squares =
        solver == GddSolver::augmentedLagrangian || model.options.cone == Cone::elliptic;
    limits.markControlled(model, trees, squares ? kControlledSoft : kControlled);
  }
  /// Makes room for steps of a model whose rows softgauss::reserveRows() has just made in `data`.
  /// Robots make room again where they first meet.
  void reserve(const Model& model, const State& state, Data& data);
  /// One step. `input` acts besides the control (disturbances). Where isRefused() the
  /// state is left as it was; limits that are none (GddStatus::badLimits) are badInput.
  SolveStatus step(const Model& model, const Input& input, State& state, Data& data,
                   ContactSource* contacts) noexcept;

  /// What those that sleep keep, for a controller of another process that goes on with them.
  template <class Archive>
  void archive(Archive& a) {
    a.sized(control, coordinates_);
    limits.commands(coordinates_, commands);
  }

  /// Before apply() outside step(): what the report counts begins anew.
  void begin() noexcept;
  const VectorX* apply(const Model& model, const State& state, Data& data) noexcept override;
  std::span<const std::uint8_t> controlled() const noexcept override {
    return solution_.controlled;
  }
  KnownTrees known() const noexcept override { return solution_.known; }
  bool addsColumns() const noexcept override { return islands_.ofTree().size() > 1; }
  bool acts() const noexcept override { return limits.open(); }
  bool letsSleep(const Model& model, int tree, double time) const noexcept override;
  std::span<const std::uint8_t> wanted() const noexcept override { return islands_.wanted(); }
  bool markChanged(const Model& model, double before, double now,
                   std::span<std::uint8_t> trees) noexcept override;
  void keep(WarmStart& warmstart, const TreeSelection& trees) noexcept override;
  /// cost ← that of the price of force, the goals that act and the motion limits, at the stages in
  /// `data`, without an applied force in them.
  void addCost(const Model& model, const State& state, Data& data, GravityCompensation& holding,
               GoalCost& cost) const;
  /// Of the last GDD solve, before the final forward step (nv).
  const VectorX& acceleration() const { return solution_.a; }
  /// Of the last GDD solve.
  const GoalIslands& islands() const { return islands_; }

 private:
  void addGoals(const Model& model, const State& state, const Data& data, GoalCost& cost) const;
  void setControl(const Data& data);
  template <class Solver>
  const VectorX* solve(Solver& used, const Model& model, const State& state, Data& data);
  template <class Solver>
  bool solveIslands(Solver& used, const Model& model, const State& state, Data& data);
  /// The solver of islands of so many controls: each has the memory of these.
  ActiveSet& solverOf(ActiveSet& first, const Model& model, int controls);
  AugmentedLagrangian& solverOf(AugmentedLagrangian& all, const Model&, int) { return all; }

  GoalIslands islands_;
  std::map<int, ActiveSet> others_;  ///< by controls; `activeSet` has the first
  int controls_ = -1;                ///< of `activeSet`
  IslandSolutions solution_;
  GddReport earlier_;  ///< parts of the step that are taken, and what was spent beside
  GoalCost cost_;
  GravityCompensation holding_;
  WarmStart between_;    ///< from one solve to the next of a step
  VectorX coordinates_;  ///< y of the control (nv)
  Input held_;           ///< over the step, with what is controlled; its τ is the control's at the
                         ///< end
  VectorX outside_;      ///< τ of the caller's input (nv), or empty
};

}  // namespace softgauss::gdd
