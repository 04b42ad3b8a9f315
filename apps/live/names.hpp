// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Names that events may hold: links, goals, joints, effects and states of a run.
///
/// A table that does not change while the run goes on, so that what answers pages may read it
/// beside the simulation.

#include <string>
#include <vector>

#include "apps/live/event.hpp"
#include "softgauss/gdd/goal_directed_step.hpp"

namespace softgauss::live {

struct JointName {
  std::string name;
  int body;
  double lower, upper;  ///< [rad or m]; ∓∞ without
  bool turns;           ///< rad, else m
};

class Names {
 public:
  Names(const Model& model, const std::vector<std::unique_ptr<gdd::Goal>>& goals);

  std::string modelName;
  std::vector<std::string> links, goals, effects;  ///< goals: distinct, in the controller's order
  std::vector<JointName> joints;
  std::vector<std::string> states;  ///< to which the run can be put

  /// Why no event can hold the name, "found 'hnd', expected …"; empty where it can.
  std::string problem(FieldKind kind, const std::string& name) const;
  /// The index of the goal or the joint.
  int goal(const std::string& name) const;
  const JointName& joint(const std::string& name) const;
};

/// What is wrong with an event, "field 'link': found …"; empty where it can be asked for.
std::string problemOf(const Event& event, const Names& names);

}  // namespace softgauss::live
