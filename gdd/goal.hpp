// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A goal: a cost on the acceleration, renewed at every step (section V of the paper).
///
/// To add a kind of goal: write a file in goals/ with a class that adds its terms to the cost.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/step/data.hpp"
#include "softgauss/engine/step/snapshot.hpp"
#include "softgauss/gdd/cost.hpp"

namespace softgauss::gdd {

/// What a goal may read: the stages of this step up to the rows.
struct GoalContext {
  const Model& model;
  const State& state;
  const Data& data;
};

/// What a viewer draws of a goal that is a place: who seeks what, at this instant.
struct GoalMark {
  int frame = 0;                        ///< index into Model::frames of the link that seeks
  Vector3 p_WPoint = Vector3::Zero();   ///< the point of that link which seeks [m]
  Vector3 p_WTarget = Vector3::Zero();  ///< the place it seeks [m]
};

/// How far a robot is from a goal, in the goal's own unit.
struct GoalError {
  double value = 0.0;       ///< ≥ 0
  const char* unit = "m";   ///< of the value
  double met = kMetLength;  ///< the goal is met where the value is at most this
  const char* what = "";    ///< tells the figures of one goal apart, e.g. "orientation"
  bool yields = false;      ///< other goals outweigh it by design: not met is no failure
  int frame = -1;  ///< index into Model::frames of the link to be moved; −1: no single one
  int dof = -1;    ///< the dof that is farthest off; −1: the goal is of no joints

  static constexpr double kMetLength = 0.01;  ///< [m]
  static constexpr double kMetAngle = 0.02;   ///< [rad]
  static constexpr double kMetSpeed = 0.01;   ///< [m/s]
  static constexpr double kMetShare = 0.05;   ///< of a force or an acceleration that is asked for
};

/// A place of a link that a goal without a weight of its own seeks: a posture yields to it.
struct LedPlace {
  int frame = 0;                                       ///< index into Model::frames
  Vector3 p_FP = Vector3::Zero();                      ///< the point of the link [m]
  bool turns = false;                                  ///< the link's orientation too
  double startTime = -kInfinity, endTime = kInfinity;  ///< when the goal acts [s]
};

/// What a figure is read from, besides the context: the contact forces of the step.
using ContactForces = std::vector<Snapshot::ContactForce>;

class Goal {
 public:
  double startTime = -kInfinity;  ///< the goal acts from here on [s]
  double endTime = kInfinity;     ///< and before this [s]
  bool isRegulariser = false;     ///< holds what other goals leave free: no aim of its own

  virtual ~Goal() = default;
  bool actsAt(double time) const { return startTime <= time && time < endTime; }
  /// Whether its wish stays where it is at this time [s]: no target that moves.
  virtual bool steadyAt(double) const { return true; }
  /// Whether it may be met at rest at this time [s]: it asks for no motion.
  virtual bool restsAt(double time) const { return steadyAt(time); }
  /// As the summary names it, e.g. "reach right_hand".
  virtual std::string name() const = 0;
  /// Adds the cost of this goal at the present state.
  virtual void addCost(const GoalContext& context, GoalCost& cost) const = 0;
  /// Whether it may cost what a tree of the model does: while it sleeps (sleep.hpp) the goal need
  /// not be asked, and it wakes when the goal begins, ends or changes.
  virtual bool concerns(const Model&, int) const { return true; }
  /// Index into Model::frames of the link that it moves; −1: none, or a robot as a whole.
  virtual int linkFrame() const { return -1; }
  /// Sets the weights that nobody has given to what they are beside a posture of this weight.
  virtual void weighBeside(double) {}
  /// What a posture leaves to it: the place it seeks, where nobody has given its weight.
  virtual std::optional<LedPlace> ledPlace() const { return std::nullopt; }
  /// The coordinates of the place it seeks [m], for who moves that; null where there is none, or
  /// where it moves by itself.
  virtual double* soughtPlace() { return nullptr; }
  /// The configuration it seeks (nq), for who changes that; null where there is none.
  virtual VectorX* soughtPositions() { return nullptr; }
  /// Nothing for a goal that is no place.
  virtual std::optional<GoalMark> mark(const GoalContext&) const { return std::nullopt; }
  /// Appends how far the robot is from the goal; nothing where it has no aim that one could reach,
  /// or none now. By default the distance of its mark.
  virtual void errors(const GoalContext& context, const ContactForces& contacts,
                      std::vector<GoalError>& out) const;
  /// Whether it may have a figure later where it has none now, as what is of forces.
  virtual bool hasLaterErrors() const { return false; }
  /// Distance from the goal [m]; nothing for a goal that is no place.
  std::optional<double> error(const GoalContext& context) const {
    const std::optional<GoalMark> m = mark(context);
    if (!m) return std::nullopt;
    return (m->p_WTarget - m->p_WPoint).norm();
  }
};

/// Their names, told apart where two are alike: "reach hand", "reach hand (2)".
std::vector<std::string> distinctNames(const std::vector<std::unique_ptr<Goal>>& goals);

/// Wakes the trees that a goal concerns: to be called after it was changed.
void wake(const Model& model, const Goal& goal, SleepState& sleep);

}  // namespace softgauss::gdd
