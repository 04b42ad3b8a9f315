// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Everything a step computes, as stages. Each stage is written by exactly one function, and
/// algorithms take the stages they need, so a signature is the data flow
/// (docs/theory/11-pipeline.md).

#include <algorithm>
#include <cstdint>
#include <memory>

#include "softgauss/engine/constraints/constraints.hpp"
#include "softgauss/engine/constraints/exact_diagonal.hpp"
#include "softgauss/engine/forces/forces.hpp"
#include "softgauss/engine/solver/newton.hpp"
#include "softgauss/engine/step/bad_input.hpp"
#include "softgauss/engine/step/body_objective.hpp"

namespace softgauss {

/// Stage written by forwardDynamics().
struct ForwardSolution {
  VectorX a;         ///< continuous-time acceleration of (1.1) (nv)
  VectorX gradient;  ///< M a + c − τ − Jᵀf, the residual force [N, N m]
  NewtonReport report;

  VectorX direction, diagonal, scale, start;  ///< scratch
};

/// Wall time of the stages of the last step [s].
struct StepTimes {
  double kinematics = 0.0;  ///< poses, velocities, mass matrix, smooth forces
  double collision = 0.0;
  double rows = 0.0;   ///< making J, a_ref, D
  double solve = 0.0;  ///< forward dynamics
  double integrate = 0.0;
};

/// What happened in the last step.
struct StepStats {
  SolveStatus status = SolveStatus::converged;
  int contacts = 0;
  int rows = 0;
  int iterations = 0;  ///< of Newton, of the island that took most; sums over solves and parts
  int factorizations = 0;
  double residual = 0.0;  ///< of the solve, the largest of a step in parts, scaled
  /// Whether what moves is what was solved: the largest |(v⁺ − v)/h − a|, a of the solve, of the
  /// goal directed one where goals act, over max(|a|∞, 1).
  double realised = 0.0;
  double maxPenetration = 0.0;  ///< deepest overlap of a contact [m], ≥ 0
  std::int64_t pairsSkipped = 0;
  int substeppedTrees = 0;       ///< that moved freely, followed within the step (6.3)
  int abandonedTrees = 0;        ///< that needed more sub-steps than allowed and took (6.2) instead
  int asleepTrees = 0;           ///< that the step has left out (sleep.hpp)
  int wokenTrees = 0;            ///< by this step
  int stabilisedBodies = 0;      ///< bodies that swing too fast, held by rows (6.9)
  int substeps = 0;              ///< of followed trees, over all of them; parts of a divided step
  int parts = 1;                 ///< into which the leapfrog has divided the step (6.3)
  int repeats = 0;               ///< solves that were repeated, with another prediction (6.2)
  int evaluations = 0;           ///< of forward dynamics, where the step looks within itself
  int rejections = 0;            ///< parts of the step that were tried and shortened
  int minimumStepsAccepted = 0;  ///< shortest parts that were taken in spite of their estimate
  int tunnellingSplits = 0;  ///< parts cut short lest shapes pass through each other unseen (7.7)
  MechanismCounts acted;     ///< how often each mechanism has
  // What was done in place of what was asked for, as abandonedTrees and minimumStepsAccepted are.
  int unconvergedSolves = 0;      ///< ended stalled or at the iteration limit
  int roundingLimitedSolves = 0;  ///< ended by rounding, within 10³ of the tolerance
  int invalidWarmStarts = 0;      ///< warm starts that are not finite: the solve began without
  int possibleTunnelling = 0;  ///< parts in which shapes may have passed through each other unseen
  int badDof = -1;             ///< with SolveStatus::notFinite: the first dof that is not finite
  BadInput badInput;           ///< with SolveStatus::badInput: what does not fit the model
  StepTimes times;  ///< where Data::timed

  /// Counts another solve within the step, and how it ended; false where it has no result.
  bool count(const NewtonReport& solve) {
    iterations += solve.iterations;
    factorizations += solve.factorizations;
    residual = std::max(residual, solve.residual);
    if (solve.status == SolveStatus::notFinite) return false;
    if (solve.status != SolveStatus::converged) status = solve.status;
    return true;
  }
  /// The step's input does not fit the model: nothing was done. False where it fits.
  bool refuse(const Model& model, const BadInput& bad);
  /// Adds those of another island, or of the next part of a step: counts and times are sums, the
  /// rest is the worst.
  void add(const StepStats& other);
};

struct IntegratorStages;
class Sleepers;
struct SubstepWorkspace;
struct VelocityDerivative;

/// Owns all memory of a simulation thread. Copies of the model share nothing. Holds for the model
/// as it was at construction.
struct Data {
  explicit Data(const Model& model);
  /// Without what integrates: to evaluate the dynamics with.
  struct Evaluation {};
  Data(const Model& model, Evaluation);
  ~Data();
  Data(const Data&) = delete;
  Data& operator=(const Data&) = delete;

  const Plan plan;  ///< what runs
  /// Of which trees the stages are: all, but in sleep.hpp and island_substeps.hpp.
  TreeSelection active;
  InverseWeights weights;  ///< constants
  Kinematics kinematics;
  MassMatrix inertia;
  SmoothForces forces;
  ContactSet contacts;
  Constraints constraints;
  ExactDiagonal exactDiagonal;
  ForwardSolution forward;
  BodySolution bodies;      ///< of the same solve, on bodies
  VectorX midstepVelocity;  ///< (nv) of mid-step, predicted: v′ of (6.2), of the leapfrog
  VectorX acceleration;     ///< discrete, (v⁺ − v)/h (nv)
  std::unique_ptr<Sleepers> sleepers;              ///< with Options::sleep, else null
  std::unique_ptr<SubstepWorkspace> parts;         ///< of the leapfrog, else null
  std::unique_ptr<IntegratorStages> stages;        ///< null where the step is one solve
  std::unique_ptr<VelocityDerivative> derivative;  ///< of the implicit integrators, else null
  bool timed = false;  ///< whether clocks are read, for StepStats::times and what goals take
  StepStats stats;
};

}  // namespace softgauss
