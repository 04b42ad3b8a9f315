// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How far a tree turns in a step, by the two parts of (6.4).

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// A tree whose energy nothing but weight and springs changes much: of several bodies, not tied,
/// not driven, and with nothing that stops within the step. The second part of (6.4) is of such
/// trees.
bool isPassive(const Model& model, const Tree& tree, bool tied, const Data& data, const VectorX& v,
               const VectorX& a);

/// The first part of (6.4), without the factor h; `change` = M⁻¹Δb (nv). Of joints that turn and
/// of those that slide, what changes by less than rounding of the tree's motion tells nothing: a
/// ball that does not spin is at 0/0.
double coriolisChangeRate(const Model& model, const Tree& tree, const Data& data, const VectorX& v,
                          const VectorX& a, const VectorX& change);
/// What Δb does to the energy of motion, against what there is: the second part of (6.4), without
/// the factor h. Both arguments are squares.
double energyRate(double change, double motion);

/// Damping stops a joint of the tree within the step, or a stiff spring turns it back: it takes the
/// end of the step (6.1), and no sub-steps follow that.
bool stopsWithin(const Model& model, const Tree& tree, const Data& data);
/// Nothing turns: a body that flies without turning, a ball, or joints that slide alone.
bool movesEvenly(const Model& model, const Tree& tree, const VectorX& v);
/// √(2 × kinetic energy) of a tree by its largest part: max_i (|v_i| + h |a_i|) √M_ii.
double treeSpeed(const Tree& tree, const Data& data, const VectorX& v, const VectorX& a, double h);
/// Applied forces, wrenches included, change the tree's motion by more than a thousandth in the
/// step.
bool drives(const Tree& tree, const Data& data, const VectorX& v, const VectorX& a, double h);
/// A body of the tree turns by more than 0.003 rad in the step, or a joint does by the velocity
/// v + h a that it ends with, or slides with as much energy, v_i √M_ii, as the joint of the tree
/// that turns most easily would have so. Below that (6.3) need not be worked out.
bool mayRotateFar(const Model& model, const Tree& tree, const Data& data, const VectorX& v,
                  const VectorX& a);

}  // namespace softgauss
