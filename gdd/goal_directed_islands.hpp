// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Goal directed dynamics of a scene that is stepped island by island (engine/islands).
///
/// A robot with actuators is controlled wherever a goal acts on it; what it touches is of its
/// island, and so of its problem (8.1). Other islands take the ordinary step: without actuators
/// there is nothing to choose, and with actuators but no goal (8) chooses none. So a robot among a
/// thousand objects pays for those that it touches, and two robots with a goal each are two
/// problems. The goals of all islands together cost what the given ones cost (Goal::within()): the
/// minimum is the same. Friction is that of a control (Input::controlled) in the trees that it acts
/// on, and in no others.
///
///   gdd::GoalDirectedController controller(model);      // goals, box, solver
///   gdd::GoalDirectedIslands controls(model, controller);
///   Islands islands(model, &contacts, Sleep{.enabled = true}, &controls);
///   islands.step(input);                                // controller.control, .report

#include <memory>
#include <vector>

#include "softgauss/engine/islands/island_control.hpp"
#include "softgauss/engine/islands/units.hpp"
#include "softgauss/gdd/goal_directed_step.hpp"

namespace softgauss::gdd {

class GoalDirectedIslands final : public IslandControls {
 public:
  /// Islands are controlled as `controller` would control the whole scene: by its goals, its
  /// limits, its control cost and its solvers' options. Its control, commands, report and solveTime
  /// are those of the last step of all islands: counts, times and objectives are sums, the rest is
  /// the worst. An island that sleeps keeps its control. Both must outlive this object.
  GoalDirectedIslands(const Model& model, GoalDirectedController& controller);
  ~GoalDirectedIslands() override;

  /// To be called after goals have been added, removed or given to others, or the limits, the
  /// control cost or options have been changed: all islands read the controller anew, and all
  /// robots wake. Throws ModelError where a goal, an actuator or the control cost ties robots that
  /// may be apart.
  void changed();
  /// To be called after this goal has been given another place, weight or time: the islands that it
  /// is about read it anew, and wake.
  void changed(std::size_t goal);

  /// What has been seen of the goals, for islands that go on later (core/bytes.hpp).
  template <class Archive>
  void archive(Archive& a) {
    a.sized(acting_);
    a(changed_);
  }

  std::unique_ptr<IslandControl> within(const SubModel& island) override;
  void begin(double time, std::vector<int>& trees) noexcept override;

 private:
  class Control;
  const Model& model_;
  const Units units_;
  GoalDirectedController& controller_;
  std::vector<Control*> controls_;  ///< of all islands that there are
  std::vector<int> acting_;         ///< (goals) in the last step: 0: no, 1: at rest, 2: it moves;
                                    ///< -1: it has been changed since
  bool changed_ = false;            ///< since the last step
};

}  // namespace softgauss::gdd
