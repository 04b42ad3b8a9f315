// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Parameters of a run, by name: what may differ from run to run of a rollout or a sweep.
///
/// | name | value |
/// |---|---|
/// | `mass:LINK` | of the link and all that is fixed to it [kg], > 0, with their inertia |
/// | `inertia:LINK` | factor on the central inertia of that body [-], > 0 |
/// | `friction:LINK`, `friction:SHAPE` | coefficient of sliding friction of its shapes [-], ≥ 0 |
/// | `damping:JOINT` | [N m s/rad or N s/m], ≥ 0 |
/// | `armature:JOINT` | [kg m² or kg], ≥ 0 |
/// | `dry_friction:JOINT` | largest force [N m or N], ≥ 0 |
/// | `effort:JOINT` | bound of the control either way [N m or N], > 0, of an actuated joint |
/// | `lower:JOINT`, `upper:JOINT` | an end of its range [rad or m], of a joint that has one |
/// | `gravity:x`, `:y`, `:z` | [m/s²], world |
/// | `timestep` | [s], > 0 |
/// | `q:JOINT` | where it, and what follows it, starts [rad or m] |
/// | `v:JOINT` | how fast it starts [rad/s or m/s] |
/// | `q:BASE.x`, `.y`, `.z` | where a floating base starts [m]; BASE is its joint, as in the log |
/// | `v:BASE.vx`, …, `v:BASE.wz` | how fast [m/s, rad/s], as in the log |
/// | `reach:LINK.x`, `.y`, `.z` | the place that the reach goal of that link seeks [m], world |
///
/// `*` stands for all where one value can be meant for all: `friction:*` is every shape and every
/// pair with a surface of its own; `damping:*`, `armature:*`, `dry_friction:*`, `effort:*`,
/// `lower:*` and `upper:*` are every joint of one degree of freedom that has it.

#include <string>
#include <vector>

#include "softgauss/gdd/goal_directed_step.hpp"

namespace softgauss {

class Parameter {
 public:
  /// Throws NameError, with the nearest name, where the model has nothing like it.
  Parameter(const Model& model, const std::string& name);

  const std::string& name() const { return name_; }
  /// Why a run cannot have this value, as a message goes on: "found -1, expected a number of at
  /// least 0"; empty where it can.
  std::string problem(double value) const;
  /// Why a run cannot start there, as problem() says it: a joint beyond its range, of those that
  /// the model has once parameters of ends are set in them (setEnd()); empty where it can.
  std::string startProblem(double value, const std::vector<JointRange>& ranges) const;
  /// Sets it in the ranges of joints, where it is an end of one.
  void setEnd(double value, std::vector<JointRange>& ranges) const;
  /// Whether it changes the model, beyond its state and goals.
  bool isOfModel() const;
  /// Sets it in the model and in the state from which a run starts.
  void apply(double value, Model& model, State& initial) const;
  /// Sets it in the goals. Throws NameError where there is no reach goal of that link.
  void apply(double value, gdd::GoalDirectedController& controller) const;

  /// Whether both set the mass of one body, by links that are fixed to each other.
  bool isOfTheSame(const Parameter& other) const;
  /// Why a model with its parameters set cannot run; empty where it can.
  static std::string problemOf(const Model& model);

  enum class Kind {
    mass,
    inertia,
    friction,
    damping,
    armature,
    dryFriction,
    effort,
    lower,
    upper,
    gravity,
    timestep,
    q,
    v,
    reach
  };

 private:
  void findLink(const Model& model, const std::string& target);
  void findShapes(const Model& model, const std::string& target);
  void findJoints(const Model& model, const std::string& target);
  void findCoordinate(const Model& model, const std::string& target);
  int splitAxis(const std::string& target, const std::vector<std::string>& axes, std::string& stem);
  [[noreturn]] void fail(const std::string& problem) const;

  std::string name_;
  Kind kind_ = Kind::mass;
  std::vector<int> indices_;  ///< bodies, geometries, dofs, ranges or one coordinate
  int body_ = 0;              ///< that the joint of a coordinate carries; 0 for a base
  std::vector<int> pairs_;    ///< of contacts with a surface of their own
  std::string link_;          ///< of a reach goal
};

/// All names that a model has, for messages and completion.
std::vector<std::string> parameterKinds();

}  // namespace softgauss
