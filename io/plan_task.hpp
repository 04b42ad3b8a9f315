// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Reads what a scene file has its robots plan, the key `plan`:
///
///   plan:
///     step: 0.05                       # h [s]
///     knots: 40                        # N
///     contacts: {margin: 0.05, width: 0.05, d_min: 1e-4, d_max: 0.95, stages: 50, factor: 0.95,
///                iterations: 5}        # in each stage
///     iterations: {infeasible: 15, feasible: 60, rho: 0.03}  # ρ with which phase I starts
///     running: {position: 2, velocity: {all: 0.1, wheel: 2}}   # ½ w e², times h at each knot
///     final: {position: {base_position: 400, base_rotation: 100, all: 10}, velocity: 1,
///             points: {hand: {target: [0.4, 0, 0.3], weight: 100, velocity: 1, point: [0, 0, 0]}},
///             orientations: {head: {rpy: [0, 0, 0], weight: 10}},
///             center_of_mass: {target: [0, 0, 0.9], weight: 100}}
///     effort: 2e-4                     # of u [1/(N² m² s)]
///     root_force: 0.02                 # of forces that nobody causes, in phase I
///     search: {tries: 40, reach: 0.5}  # better plans near the one that is found
///     mpc: {rate: 50, iterations: 0, seconds: 0.01, contacts: own, keep: true}
///                      # planned anew [1/s], with phase F beside each pass, in that time, on
///                      # these contacts; the final terms are kept
///     spread: 0.1                      # of random starts, for plan_benchmark
///     best: 3.8                        # least cost that is known, for plan_benchmark
///     target: {joints: {wheel: 2}, move: [0.4, 0, 0], steady: true}
///
/// A weight is one number for all degrees of freedom, or a map of joints; base_position and
/// base_rotation are what floats. The target is the start at rest but for what is given: joints,
/// position [m] and rpy of the one floating base, or by how much it moves; steady has it move there
/// at one speed. `contacts` are those with which it plans; from there stages lead to the scene's
/// own, but with `end: planning`. Running terms, and final ones, are also of `points` of links,
/// given in the link's frame, and their speed, of `orientations` of links, both in the world, and
/// of the centre of mass of all that moves. Strict, as scenes are.

#include <filesystem>
#include <optional>

#include "softgauss/engine/model/state.hpp"
#include "softgauss/gdd/planning/receding_horizon.hpp"

namespace softgauss::io {

struct PlanTask {
  planning::PlanSteps steps;
  planning::PlanOptions options;
  std::optional<planning::Continuation> contacts;
  planning::PlanSearch search;
  planning::HorizonOptions mpc = {.period = 0.02, .keepsEnd = true};
  bool recedesOnOwnContacts = true;  ///< else on the planning ones, 5 mm apart at most
  bool endsOnOwnContacts = true;     ///< else on the planning ones
  struct Point {
    std::string link;
    Vector3 p_LP = Vector3::Zero(), target = Vector3::Zero();  ///< world [m]
    double weight = 0.0, velocity = 0.0;                       ///< [1/m²], [s²/m²]
  };
  struct Orientation {
    std::string link;
    Matrix3 target = Matrix3::Identity();  ///< world
    double weight = 0.0;                   ///< [1/rad²]
  };
  struct StateWeights {
    VectorX position, velocity;  ///< (nv)
    std::vector<Point> points;
    std::vector<Orientation> orientations;
    std::optional<std::pair<Vector3, double>> centerOfMass;  ///< target [m], weight [1/m²]
  };
  StateWeights running, final;
  VectorX effort, rootForce;  ///< (nv)
  double spread = 0.1;        ///< of random accelerations to start from [m/s², rad/s²]
  double best = 0.0;          ///< least cost that is known; 0: none
  std::vector<VectorX> q, v;  ///< target: one, or one of each knot

  /// Gives the planner, of this model and steps, the costs.
  void setCosts(planning::Planner& planner) const;
  const planning::MotionPlan& solve(planning::Planner& planner, const State& start,
                                    const std::vector<VectorX>& accelerations = {}) const;
  /// By phase F alone with these options, on the planning contacts and then on the scene's own.
  const planning::MotionPlan& solveFeasible(planning::Planner& planner, const State& start,
                                            const planning::PlanOptions& options,
                                            const std::vector<VectorX>& accelerations = {}) const;
};

/// `start`: the state in which the scene starts. Throws ModelError, also where the file has no
/// plan.
PlanTask readPlanTask(const std::filesystem::path& file, const Model& model, const State& start);

/// The same of a scene's text, YAML or JSON, which messages call `name`.
PlanTask parsePlanTask(const std::string& text, const std::string& name, const Model& model,
                       const State& start);

}  // namespace softgauss::io
