// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far a tree turns in a step, by the two parts of (T.93), and from where on that is followed.

#include "engine/step/data.hpp"

namespace softgauss {

/// What connections and welds hold is followed where it turns by more in a step [rad].
constexpr double kTiedTurn = 0.1;

/// A tree that is followed stays so until it is below a part of the threshold. Each change from the
/// leapfrog's energy to its own and back is off by what the two differ by, of order h² and of one
/// sign: what is passive gains by it, and stays followed until it is all but at rest. What is
/// damped much or driven does not, and a controller at its limits feels every change; what ties do
/// to a tree that is followed is the coarser part of the step.
struct Following {
  double staysFree, staysPushed;  ///< parts of FollowedTrees::kFollowedTurn; pushed by rows
  bool byEnergy;                  ///< by the second part of (T.93) too
};
/// How long this tree stays so. A single body has no joints that could hide a turn.
Following followingOf(const Tree& tree, bool tied, const Data& data, const VectorX& v,
                      const VectorX& a, double h);

/// The first part of (T.93), without the factor h; `change` = M⁻¹Δb (nv). Of joints that turn and
/// of those that slide, what changes by less than rounding of the tree's motion tells nothing: a
/// ball that does not spin is at 0/0.
double turnRate(const Model& model, const Tree& tree, const Data& data, const VectorX& v,
                const VectorX& a, const VectorX& change);
/// What Δb does to the energy of motion, against what there is: the second part of (T.93), without
/// the factor h. Both arguments are squares.
double energyRate(double change, double motion);

/// Damping stops a joint of the tree within the step: no sub-steps follow that.
bool dampingStops(const Tree& tree, const Data& data, double h);
/// √(2 × kinetic energy) of a tree by its largest part: max_i (|v_i| + h |a_i|) √M_ii.
double treeSpeed(const Tree& tree, const Data& data, const VectorX& v, const VectorX& a, double h);
/// Applied forces change the tree's motion by more than a thousandth in the step.
bool drives(const Tree& tree, const Data& data, const VectorX& v, const VectorX& a, double h);
/// A body turns by more than 0.005 rad in the step, or a joint does by the velocity v + h a that it
/// ends with, or slides with as much energy, v_i √M_ii, as the joint of its tree that turns most
/// easily would have so. Below that (T.93) need not be worked out.
bool mayTurnFar(const Model& model, const Data& data, const VectorX& v, const VectorX& a);
/// By which a body turns in a step [rad].
double stepAngle(const Model& model, const Data& data, int body);
/// A tree of one body.
inline bool isSingle(const Tree& tree) { return tree.bodyEnd == tree.rootBody + 1; }

}  // namespace softgauss
