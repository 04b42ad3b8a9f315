// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Balance of a robot that stands: what a reach comes with, so that the robot goes on standing.
///
/// The support is the convex hull of the points on which the links stand that stood at the start
/// and have not left the ground, but for those that a goal lifts. Let m be its middle, n·p ≤ h one
/// of its edges, and λ = 0.75. The capture point ξ = x + ẋ/ω₀ (balance.hpp) is kept within
/// n·ξ ≤ b = n·m + λ (h − n·m):
///   ½ w max(0, n·ẍ + ω₀ (n·ẋ + β (n·ξ − b)))²,  that is  n·ξ̇ ≤ −β (n·ξ − b)
/// Within the support it asks for nothing, and ξ comes to its edge no faster than at the rate β.
/// The support is what it is said to be as long as feet stay flat: of the points on which one
/// stands, z above where they were at the start, and of one that rolls of where it touches,
///   ½ w_f max(0, z̈ + 2 γ ż + γ² max(0, z − z₀))²,   z₀ = 0.5 mm
///
/// No weight keeps a robot standing that is pulled by a place beyond its reach: what is out of
/// reach pulls for good. Hence goals of links fade as the robot becomes unsteady,
///   s = S(ρ; 0.3, 0.8) S(θ; 0.3, 0.6) min(1, 0.2 m/d)
/// their weights and what a posture yields to them (9.24) count s times. ρ is how far ξ is on the
/// way from where the centre of mass was at the start to an edge of the support; θ the turn of the
/// base since then; d how far the place is; S goes smoothly from 1 at the first bound to 0 at the
/// second. By as much as they fade angular momentum is damped, lest arms and trunk swing for what
/// the feet cannot do.
///
/// A goal lifts a link that stands where it seeks a place for a body of its leg that is farther
/// than 1 cm away, and as long as the link is off the ground then; a leg is what moves one such
/// link and no other. Until the link has left the ground, the goal waits for ξ to be in the rest of
/// the support, shrunk to 0.9: what is to be lifted is unloaded first. Where fewer than two links
/// would be left to stand on, it waits for ever: to stand on one leg is no matter of defaults; so
/// does what would press a link into the ground. Such a goal does not fade. As long as a goal lifts
/// something, base and links on the ground are held too, the base in height and orientation by a
/// spring-damper to where it was at the start, and the robot's angular momentum is damped.
///
/// Its weight is 100 times that of a reach.

#include "softgauss/engine/step/contact_source.hpp"
#include "softgauss/gdd/goal.hpp"
#include "softgauss/gdd/goals/default_weight.hpp"
#include "softgauss/gdd/goals/support_polygon.hpp"

namespace softgauss::gdd {

class StandingBalance final : public Goal {
 public:
  using Goals = std::vector<std::unique_ptr<Goal>>;
  struct FootPoint {
    Vector3 p_BP;   ///< in the body's frame [m]
    double height;  ///< upwards, at the start [m]
  };
  struct Foot {                     ///< a link on which the robot stood at the start
    int body = 0;                   ///< of the link
    std::vector<int> leg;           ///< bodies that move it and no other foot
    std::vector<FootPoint> points;  ///< on which it stood
    /// A ball or an edge turns about where it stands.
    bool isFlat() const { return points.size() > 2; }
  };

  int robot = 0;                ///< Body::robot
  int base = 0;                 ///< its root body
  std::vector<Foot> feet;       ///< at least one
  Transform X_WBase;            ///< where the base was at the start
  Vector3 p_WStart;             ///< where the centre of mass was then
  double weight = 0.0;          ///< w [kg]; default 250 × the robot's mass
  DefaultWeight defaultWeight;  ///< of w
  double rate = 10.0;           ///< β [1/s]
  double stiffness = 100.0;     ///< of the base [1/s²]
  double damping = 20.0;        ///< of the base, and of links on the ground [1/s]

  /// One for each robot of the model that stands in `start`: its base floats, joints of it are
  /// driven, and its centre of mass is over what touches the world where it is lowered by 5 mm.
  static Goals ofRobotsThatStand(const Model& model, const State& start, ContactSource& contacts);

  std::string name() const override { return "balance"; }
  void weighBeside(double posture) override { defaultWeight.setBeside(posture, weight); }
  /// As one goal among others, which may lift links.
  void addCost(const GoalContext& context, const Goals& others, GoalCost& cost) const;
  void addCost(const GoalContext& context, GoalCost& cost) const override {
    addCost(context, {}, cost);
  }
  /// The support: of the feet that stand and that no goal lifts.
  SupportPolygon rest(const GoalContext& context, const Goals& others) const;
  /// s above but for the distance: 1 of a robot that stands safely, 0 of one that is about to fall.
  double steadiness(const GoalContext& context, const SupportPolygon& support) const;
  /// s of another goal; 0 where it waits until what it lifts is unloaded.
  double share(const GoalContext& context, const Goals& others, const Goal& goal) const;
  bool concerns(const Model& model, int tree) const override {
    return model.bodies[idx(base)].tree == tree;
  }

 private:
  StandingBalance(const Model& model, int tree, const Kinematics& start);
  bool lifts(const GoalContext& context, const Goal& goal, const Foot& foot) const;
  bool presses(const GoalContext& context, const Goal& goal, const Foot& foot,
               const Vector3& up) const;
  bool isSought(const GoalContext& context, const Goals& others, const Foot& foot) const;
  bool isLifted(const GoalContext& context, const Goals& others, const Foot& foot) const;
  std::optional<Vector3> capturePoint(const GoalContext& context,
                                      const SupportPolygon& support) const;
  Vector3 turnBack(const GoalContext& context) const;
  void keepUp(const GoalContext& context, const Vector3& up, GoalCost& cost) const;
  void keepFlat(const Foot& foot, bool steady, const GoalContext& context, const Vector3& up,
                GoalCost& cost) const;
  void keepWithin(const SupportPolygon& support, double omega, const Centroidal& c,
                  GoalCost& cost) const;
};

/// What share of a goal the balances among the goals leave to act now, and which of them leaves
/// least.
double shareAmong(const std::vector<std::unique_ptr<Goal>>& goals, const Goal& goal,
                  const GoalContext& context, int* by = nullptr);

/// Adds the cost of a goal that acts now, or of a part of it, as one among others: by the share
/// that balances leave.
void addCostAmong(const std::vector<std::unique_ptr<Goal>>& goals, const Goal& goal,
                  const GoalContext& context, GoalCost& cost, const Goal* part = nullptr);

}  // namespace softgauss::gdd
