// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the next step depends on, and what the caller applies to it.

#include <cstdint>
#include <vector>

#include "softgauss/engine/core/segment.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss {

/// A constraint row, named by what it is of, so that the next step finds it again: its place among
/// the rows changes from step to step as contacts come and go.
struct RowKey {
  int first = 0;      ///< a dof, or the geometries that touch
  int second = 0;     ///< and the other one, or the end of a range
  int contact = 0;    ///< among the contacts of the pair
  int direction = 0;  ///< among the rows of the contact
  bool operator==(const RowKey&) const = default;
};

/// A breakpoint of a row's penalty, named likewise.
struct BreakpointKey {
  int kind = 0;  ///< of constraint
  RowKey row;
  int index = 0;  ///< among the breakpoints of the row, upwards
  bool operator==(const BreakpointKey&) const = default;
};

/// Solutions of the last step, from which the next solve starts: they may choose a local minimum.
struct WarmStart {
  VectorX a;            ///< acceleration of the forward solve (nv)
  VectorX gddA;         ///< acceleration of the GDD solve (nv)
  VectorX multipliers;  ///< of g_z = 0 and of the control limits, GDD solver 1 (nv)
  VectorX control;      ///< of GDD solver 2, coordinates y of its force (nv)
  std::vector<BreakpointKey> breakpoints;  ///< at which rows are, GDD solver 2
  /// (trees) Of the island whose first tree it is: solves since GDD solver 2 last looked for a
  /// better minimum, and solves from that search to the next.
  std::vector<int> gddSearchAge, gddSearchWait;
  bool valid = false;  ///< a is set
  bool gddValid = false;
};

/// Who sleeps, and who is about to (step/sleep.hpp). Empty where Options::sleep is off.
struct SleepState {
  /// (trees) The first tree of the island with which it fell asleep; −1: it is awake.
  std::vector<int> island;
  std::vector<double> restTime;   ///< (trees) for which it has been at rest [s]
  std::vector<double> restSpeed;  ///< (trees) of its fastest link when it came to rest [m/s]
  VectorX restVelocity;           ///< (nv) v then
  /// (nv) of servos, as they were told last; empty where there are none.
  VectorX setPoint, setPointRate;
  double lastTime = -kInfinity;  ///< at which the last step began [s]; −∞: there was none

  bool isAsleep(int tree) const { return !island.empty() && island[idx(tree)] >= 0; }
};

/// Everything that the next step depends on, and nothing else. Copyable.
struct State {
  VectorX q;          ///< configuration (nq)
  VectorX v;          ///< generalised velocity (nv)
  double time = 0.0;  ///< [s]
  VectorX a;          ///< acceleration by which the last step ended (nv), of the leapfrog
  bool hasAcceleration = false;  ///< a is set
  /// Of each connection, in the solve of the last step: its force on body A, and those of all rows
  /// on the trees that A and B float in, else 0; world axes (9 × connections) [N]. From these
  /// follows the geometric stiffness of the next step (6.8). Zero or empty: none is known.
  VectorX connectionForces;
  WarmStart warmstart;
  SleepState sleep;

  State() = default;
  /// At rest in the model's initial configuration.
  explicit State(const Model& model);

  /// To be called where q or v have been put elsewhere than the last step has ended: what it has
  /// found says nothing there. The warm start, a guess, stays.
  void forgetLastStep() {
    hasAcceleration = false;
    connectionForces.setZero();
  }
};

/// Wakes a tree and all that fell asleep with it; to be called where its q has been changed. A v
/// that is not zero wakes it too.
void wake(SleepState& sleep, int tree);
/// Wakes all.
void wakeAll(SleepState& sleep);

/// An external force on a body: wrench about the body's origin, in world axes.
struct ExternalWrench {
  int body = 0;
  Force F_Bo_W;  ///< moment [N m] about Bo and force [N]
};

/// What acts on the system during a step besides its own forces.
struct Input {
  VectorX tau;  ///< generalised applied force (nv) [N or N m]; empty: none
  std::vector<ExternalWrench> wrenches;
  /// (trees) kControlled where a control acts on the tree, 0 elsewhere; empty: on none. Dry
  /// friction of its joints is as soft at rest as in motion, and creeps under load: (5.6) is left
  /// out, for what sticks hard hides from goals what a larger control would gain. Its contacts
  /// stick, up to a hundred times as hard (5.7). kControlledSoft: contacts do not harden either.
  /// All other rows are as they are without a control, bit for bit.
  std::vector<std::uint8_t> controlled;
  /// (nv) of servos, at the step's end [rad or m, rad/s or m/s]; empty: those of Servo.
  VectorX setPoint = {}, setPointRate = {};
};

/// Of Input::controlled.
inline constexpr std::uint8_t kControlled = 1;
inline constexpr std::uint8_t kControlledSoft = 2;

/// Input::controlled where a control acts on every tree.
inline std::vector<std::uint8_t> allTrees(const Model& model, std::uint8_t mark = kControlled) {
  return std::vector<std::uint8_t>(model.trees.size(), mark);
}

/// 64-bit hash of a state, bit for bit.
std::uint64_t hash(const State& state);

/// q ← q ⊕ h v on the configuration manifold; v in the convention of JointKind.
void integratePosition(const Model& model, const VectorX& v, double h, VectorX& q);
/// The same of these bodies alone.
void integratePosition(const Model& model, const VectorX& v, double h, Segments bodies, VectorX& q);

/// The v with q1 = q0 ⊕ v (the inverse of integratePosition with h = 1).
VectorX positionDifference(const Model& model, const VectorX& q0, const VectorX& q1);
/// The same into v, which has its size.
void positionDifference(const Model& model, const VectorX& q0, const VectorX& q1, VectorX& v);

}  // namespace softgauss
