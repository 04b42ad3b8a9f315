// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a step of this model will run, found once from its elements and Options::effects.
///
/// The stages read the plan instead of looking for elements at every step: what is not in it is
/// neither called nor given memory. It holds for the model that it was made from; Data makes it, so
/// a model that is changed needs a new Data.

#include <cstdint>
#include <vector>

#include "softgauss/engine/model/model.hpp"

namespace softgauss {

/// The kinds of rows, in the order of Constraints::visit().
enum class RowKind : std::uint8_t {
  connection,
  weld,
  coupling,
  dryFriction,
  jointLimit,
  servo,
  geometricStiffness,
  pyramid,
  ellipticCone
};
inline constexpr int kRowKinds = 9;

/// A set of them.
class RowKinds {
 public:
  static constexpr RowKinds all() { return RowKinds((1u << kRowKinds) - 1u); }
  static constexpr RowKinds none() { return RowKinds(0u); }
  constexpr bool has(int kind) const { return (bits_ >> kind) & 1u; }
  constexpr bool has(RowKind kind) const { return has(static_cast<int>(kind)); }
  constexpr void insert(int kind) { bits_ |= 1u << kind; }
  constexpr void insert(RowKind kind) { insert(static_cast<int>(kind)); }
  constexpr RowKinds with(RowKind kind) const {
    return RowKinds(bits_ | 1u << static_cast<unsigned>(kind));
  }
  constexpr bool empty() const { return bits_ == 0u; }
  constexpr bool operator==(const RowKinds&) const = default;

 private:
  explicit constexpr RowKinds(unsigned bits) : bits_(bits) {}
  unsigned bits_;
};

/// The kinds whose code is in this build.
constexpr RowKinds builtRows() {
  RowKinds rows = RowKinds::none();
  const auto add = [&](RowKind kind, auto... effects) {
    if ((kBuiltEffects.has(effects) || ...)) rows.insert(kind);
  };
  for (const RowKind kind :
       {RowKind::connection, RowKind::weld, RowKind::coupling, RowKind::geometricStiffness})
    add(kind, Effect::equality);
  add(RowKind::dryFriction, Effect::dryFriction);
  add(RowKind::jointLimit, Effect::jointLimit);
  add(RowKind::servo, Effect::actuation);
  for (const RowKind kind : {RowKind::pyramid, RowKind::ellipticCone})
    add(kind, Effect::selfCollision, Effect::groundContact, Effect::objectContact);
  return rows;
}
inline constexpr RowKinds kBuiltRows = builtRows();

struct Plan {
  struct Spring {
    int dof = 0;
    int q = 0;               ///< of its joint
    double stiffness = 0.0;  ///< [N m/rad or N/m]
    double reference = 0.0;  ///< q at rest
    bool operator==(const Spring&) const = default;
  };

  bool gravity = false;         ///< a gravity that is not zero
  bool bearsWeight = false;     ///< of which a body's part is borne (Body::borneMass)
  bool coriolis = false;        ///< a body that can turn
  bool drifts = false;          ///< the leapfrog: positions drift to mid-step before the solve
  bool inSolve = false;         ///< Options::implicitInSolve, of semi-implicit Euler and leapfrog
  bool externalWrench = false;  ///< wrenches of Input count
  /// (trees) 1: M has nothing beside the diagonal there, so that it is divided by, not factored.
  std::vector<std::uint8_t> diagonal;
  bool allDiagonal = false, anyDiagonal = false;
  VectorX damping;  ///< (nv) of the dofs; empty: none has any
  std::vector<Spring> springs;
  RowKinds rows = RowKinds::none();  ///< kinds of rows that may be made
  /// Effects that run: what an element calls for and Options::effects has.
  EffectSet effects = EffectSet::none();

  Plan() = default;
  explicit Plan(const Model& model);
  bool hasDamping() const { return kBuiltEffects.has(Effect::damping) && damping.size() > 0; }
  bool hasSprings() const { return kBuiltEffects.has(Effect::spring) && !springs.empty(); }
  bool hasExternalWrench() const {
    return kBuiltEffects.has(Effect::externalWrench) && externalWrench;
  }
  /// Whether the model still has the options, dampings and dry friction of this. For assertions.
  bool fits(const Model& model) const;

 private:
  Options options_;
};

}  // namespace softgauss
