// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The dataset of the paper's section VI: records of a robot that a scripted operator drags about.
///
/// A record is what one step, or a part of one, solves from, with both warm starts, the goal, and
/// the control that was found: enough to solve it again, bit for bit.

#include <memory>
#include <string>
#include <vector>

#include "apps/gdd_benchmark/scripted_operator.hpp"
#include "apps/gdd_benchmark/solver_under_test.hpp"
#include "apps/shared/progress.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/gdd/goals/virtual_damping.hpp"

namespace softgauss::app {

/// A robot on the ground.
struct Robot {
  std::string name;
  Model model;
  std::unique_ptr<collision::SceneContacts> contacts;
  State initial;
  Input input;               ///< no force; its trees are those that goals control
  double deviate = 0.5;      ///< σ of the operator's targets [m]
  double lowest = 0.1;       ///< least z of a target [m]
  double weightScale = 1.0;  ///< weight of its goals over that of the humanoid's [-]
};

/// `humanoid` stands and `hand` lies on the ground, neither held by anything; `held_hand` is the
/// hand with its forearm fixed, palm down, 0.15 m above the ground.
std::vector<std::string> robotNames();
/// `name` is one of robotNames(); `folder` has humanoid.urdf and hand.urdf. Throws ModelError.
/// `mark`: how a control acts on it (Input::controlled).
std::unique_ptr<Robot> loadRobot(const std::string& folder, const std::string& name,
                                 std::uint8_t mark);

struct Record {
  State state;  ///< of the solve: q at mid-step
  double timestep = 0.0, outerTimestep = 0.0,
         nextTimestep = 0.0;  ///< of Options, those of the part
  VectorX control;            ///< applied, within its box (nv) [N or N m]
  VectorX acceleration;       ///< the solver's own, before the control was clamped (nv)
  gdd::GddStatus status = gdd::GddStatus::converged;
  int contacts = 0;
  int goal = 0;  ///< index into Dataset::goals
};

struct Dataset {
  std::string recorder;  ///< the solver that found the controls
  double weight = 0.0;   ///< of the goals, w [kg]
  std::vector<gdd::Reach> goals;
  std::vector<Record> records;  ///< in the order of time
};

/// The goal directed problem at the state of the stages in `data`: clears `cost`, then adds the
/// reach and virtual damping (26) with α = 0.1, β = 10 1/s.
void poseProblem(const gdd::Reach& reach, const gdd::GoalContext& context, gdd::GoalCost& cost);

/// That damping.
gdd::VirtualDamping datasetDamping();

/// Simulates until there are `records` of them, under the operator's goals and records them; fewer
/// on an interrupt. `weight` is the humanoid's w [kg]. Throws std::runtime_error when the state
/// becomes non-finite.
Dataset recordRun(const Robot& robot, SolverUnderTest& recorder, int records, double weight,
                  std::uint64_t seed, Progress& progress);

}  // namespace softgauss::app
