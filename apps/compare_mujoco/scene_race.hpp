// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A scene stepped by both engines in turn, each by its defaults, along the path of ours.
///
/// The path is ours by default; pieces of it are windows, of which the start and the torques are
/// kept. For a window an engine gets (q, v) and a warm start, takes two steps that are not timed,
/// by which it has its own warm start, and then those that are. Of each window and engine the least
/// time of the rounds counts, and of these the mean: CPU time of the thread.

#include <string>

#include "apps/compare_mujoco/table_scenes.hpp"

namespace softgauss::app {

struct RaceTimes {
  double ours = 0.0, mujoco = 0.0;  ///< [µs]
};

struct RaceResult {
  RaceTimes step;
  RaceTimes inverse;      ///< where TableScene::inverse
  RaceTimes derivatives;  ///< where TableScene::derivatives: ours analytic, with those by forces
                          ///< too; MuJoCo's by differences, without
  double reaching = 0.0;  ///< our controlled step, of Drive::reach [µs]
  double apart = 0.0;     ///< of the links of both at the end of a window, at most [m]
  int dofs = 0, rounds = 0;
  std::string refused;  ///< why there is no figure; empty: there is
};

struct RaceOptions {
  int rounds = 20;
  int fewestRounds = 3;       ///< that a scene has, however long they take
  double mostSeconds = 60.0;  ///< after which a scene has no further round
};

/// Two engines make the same motion where their links end a window no further apart than this [m],
/// or than this share of the way that they have gone in it, root mean squares over links. (MuJoCo's
/// step is of first order: 1 mm after 44 ms of a humanoid that falls.)
inline constexpr double kMostApart = 1e-2, kMostOfWay = 0.1;

/// Refuses where an engine refuses the model, MuJoCo warns, a state is not finite, or the motions
/// of the two are not the same.
RaceResult race(const TableScene& scene, const RaceOptions& options);

}  // namespace softgauss::app
