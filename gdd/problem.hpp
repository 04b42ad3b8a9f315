// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The goal directed dynamics problem in its inverse form, equation (8) of the paper:
///
///   min_a  ½ g(a)ᵀ R g(a) + ℓ(a)   subject to  lower ≤ y ≤ upper,  g(a) = T y                (8.1)
///
/// g is the inverse dynamics (1.2), y its coordinates: commands u of actuators, and forces z that
/// no actuator causes (8.3). T is the identity unless actuators have gears or drive several dofs.
/// A coordinate without an actuator has lower = upper = 0 (the paper's g_z = 0), a command its
/// effort limits, or no bound. A solution is an acceleration that the actuators can cause, with
/// contact forces that the physics agrees to.

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "softgauss/engine/model/model.hpp"
#include "softgauss/engine/step/bad_input.hpp"
#include "softgauss/gdd/transmission.hpp"

namespace softgauss::gdd {

struct ControlLimits {
  VectorX lower;  ///< (nv) of y [N or N m, or the unit of a command]
  VectorX upper;
  std::shared_ptr<const Transmission> transmission;  ///< null: y = g, τ is selected by the limits

  ControlLimits() = default;
  /// One actuator for each actuated dof, with the effort of its joint.
  explicit ControlLimits(const Model& model) : lower(model.nv), upper(model.nv) {
    const bool actuation = model.options.effects.has(Effect::actuation);
    for (int i = 0; i < model.nv; ++i) {
      const Dof& dof = model.dofs[static_cast<std::size_t>(i)];
      const bool free = actuation && dof.actuated;
      lower[i] = free ? dof.effortLower : 0.0;
      upper[i] = free ? dof.effortUpper : 0.0;
    }
  }
  /// These actuators. A dof that none of them pulls keeps its own, if it has one; of one that they
  /// pull, the joint's effort is no bound any more. Throws ModelError as Transmission does.
  ControlLimits(const Model& model, std::vector<Actuator> actuators);

  /// The first coordinate whose bounds leave no finite value, or −1: a box has lower ≤ upper, lower
  /// < ∞ and upper > −∞ (nv).
  int firstBad(int dofs) const {
    const Segment all{0, dofs};
    return firstBad(dofs, {&all, 1});
  }
  /// The same of these.
  int firstBad(int dofs, Segments coordinates) const {
    if (lower.size() != dofs || upper.size() != dofs) return 0;
    for (const Segment s : coordinates)
      for (int i = s.begin; i < s.end; ++i)
        if (!(lower[i] <= upper[i] && lower[i] < kInfinity && upper[i] > -kInfinity)) return i;
    return -1;
  }
  /// firstBad() as a step tells it.
  BadInput badInput(int dofs, Segments coordinates) const {
    for (const VectorX* x : {&lower, &upper})
      if (x->size() != dofs)
        return {BadInputKind::controlLimitsSize, -1, static_cast<double>(x->size()),
                static_cast<double>(dofs)};
    const int bad = firstBad(dofs, coordinates);
    return bad < 0 ? BadInput{} : BadInput{BadInputKind::controlLimits, bad, 0.0, 0.0};
  }
  /// Whether the box leaves anything to choose.
  bool open() const { return (lower.array() != 0.0).any() || (upper.array() != 0.0).any(); }
  /// Marks the trees, in Input::controlled, on which forces act among which the box leaves a
  /// choice.
  void markControlled(const Model& model, std::vector<std::uint8_t>& trees,
                      std::uint8_t mark = kControlled) const;
  /// Appends the pairs of bodies whose joints an actuator pulls together.
  void appendPairs(const Model& model, std::vector<std::pair<int, int>>& pairs) const;
  /// Opens the limits of every force that no actuator causes: root forces are then allowed, and
  /// applied.
  void allowRootForces(const Model& model) {
    for (int i = 0; i < model.nv; ++i)
      if (isRootForce(model, i)) lower[i] = -kInfinity, upper[i] = kInfinity;
  }
  /// Whether coordinate i is a root force, one of z.
  bool isRootForce(const Model& model, int i) const {
    if (transmission && transmission->pulls(i)) return transmission->isRootForce(i);
    return !model.dofs[static_cast<std::size_t>(i)].actuated;
  }
  /// Whether coordinate i is the force on dof i.
  bool isPlain(Eigen::Index i) const {
    return !transmission || transmission->isPlain(static_cast<int>(i));
  }
  /// y_i of the force g.
  double coordinate(Eigen::Index i, const VectorX& g) const {
    return isPlain(i) ? g[i] : transmission->C().row(i).dot(g);
  }
  /// y ← C g, all coordinates of the force g.
  void coordinates(const VectorX& g, VectorX& y) const {
    y = g;
    if (!transmission) return;
    for (Eigen::Index i = 0; i < g.size(); ++i) y[i] = coordinate(i, g);
  }
  /// x ← x + Cᵀ s: a slope in y as a slope in g.
  void addSlope(const VectorX& s, VectorX& x) const {
    if (!transmission)
      x += s;
    else
      x.noalias() += transmission->C().transpose() * s;
  }
  /// The largest force on a dof that coordinate i = 1 makes.
  double forcePerUnit(Eigen::Index i) const {
    return transmission ? transmission->forcePerUnit(static_cast<int>(i)) : 1.0;
  }

  /// How far coordinates of g are outside their bounds, as the force that this makes; the largest
  /// [N or N m].
  double violation(const VectorX& g) const {
    const Segment all{0, static_cast<int>(g.size())};
    return violation({&all, 1}, g);
  }
  /// The same of these coordinates.
  double violation(Segments coordinates, const VectorX& g) const {
    double most = 0.0;
    for (const Segment s : coordinates)
      for (int i = s.begin; i < s.end; ++i) {
        const double y = coordinate(i, g);
        const double over =
            std::abs(y - std::min(std::max(y, lower[i]), upper[i])) * forcePerUnit(i);
        if (!(over <= most)) most = over;  // NaN stays
      }
    return most;
  }
  /// tau ← the force within the limits that has the coordinates of g, clamped; y ← those.
  void clamp(const VectorX& g, VectorX& tau, VectorX& y) const;
  /// The same of these dofs, which no actuator pulls together with others.
  void clamp(Segments dofs, const VectorX& g, VectorX& tau, VectorX& y) const;
  VectorX clamp(const VectorX& g) const {
    VectorX tau, y;
    clamp(g, tau, y);
    return tau;
  }
  /// Commands of the actuators of the transmission, in their order, from all coordinates y.
  void commands(const VectorX& y, VectorX& u) const {
    u.resize(transmission ? static_cast<Eigen::Index>(transmission->actuators().size()) : 0);
    for (Eigen::Index k = 0; k < u.size(); ++k)
      u[k] = y[transmission->coordinateOf(static_cast<int>(k))];
  }
};

}  // namespace softgauss::gdd
