// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Into how many parts a step of the leapfrog goes, and which trees move freely through it.
///
/// A step takes M, J and the inertial forces in one place. Where these turn far on its way it is
/// divided: h r ≤ substepAngle in each part, with r the fastest of all turning,
///
///   r = max( 4 √(2 turn)/h   of each tree's inertial forces, turn of (6.4)
///            |ω − (ω·n) n|   of what touches, n the normal, but for spheres
///            |s|/5           of a rim, s the rate at which the place of contact goes round it
///            4 |ω|           of what connections and welds hold
///            4 |p″ q̇|/(1 + p′²)   of a coupling, by which (1, −p′) turns )                   (6.3)
///
/// Islands that need no parts, or fewer than others, take no more than they need: r is found of
/// each tree, what two trees share counts for both, and step() asks of those that move together.
///
/// turn is about ½ (h ω)² for a body that tumbles at ω, and nothing for a wheel or a ball. Of a
/// tree that is pushed it is the lesser of two: of v′, what forces do to the velocity included, and
/// of v″ = v′ − ½ h M⁻¹c, c(q, v′) its Coriolis forces alone. For what a push does to the velocity
/// is in the solve already. So r is a function of the state alone, its last acceleration included.
/// It is not looked for where a tree may not turn far (mayRotateFar()).
///
/// A part that comes to need more than two itself has the step begin again, in so many more.
///
/// A tree that no row acts on, no control and no force to speak of, needs no parts: it is followed
/// by itself (tree_substepping.hpp), whatever the step, so that its error falls with the step; and
/// so is one without rows that would need more than kMaxDivisions. What a joint's damping or spring
/// ends within the step is left to the solve. With an infinite substepAngle no step is divided and
/// no tree is followed.

#include <cstdint>
#include <vector>

#include "softgauss/engine/model/state.hpp"

namespace softgauss {

struct Data;

class SubstepSelection {
 public:
  static constexpr int kMaxDivisions = 400;

  int parts = 1;                       ///< the most of any tree
  std::vector<int> partsOf;            ///< (trees) what each needs
  std::vector<double> coriolisChange;  ///< (trees) of (6.4), in a step
  std::vector<std::uint8_t> free;      ///< (trees) 1: it is followed by itself
  bool anyFree = false;

  SubstepSelection() = default;
  explicit SubstepSelection(const Model& model);

  /// For the stages of `data`, which are those of `state`. `controlled`: a control acts on all
  /// trees with actuators.
  void find(const Model& model, const State& state, bool controlled, Data& data);
  std::size_t bytes() const;

 private:
  double coriolisChangeBy(const Model& model, int tree, const State& state, const VectorX& a,
                          Data& data);
  void findCoriolisChanges(const Model& model, const State& state, Data& data);
  bool findAlone(const Model& model, Data& data);
  void findTouched(const Model& model, const Data& data);
  void findFree(const Model& model, const Data& data, const State& state, bool controlled);
  bool findTurning(const Model& model, const Data& data, const State& state);
  void findRates(const Model& model, const State& state, Data& data);
  void findContactRates(const Model& model, const Data& data);
  void findTieRates(const Model& model, const Data& data, const State& state);
  template <class Rate>
  void raise(const Model& model, int bodyA, int bodyB, Rate&& rate);
  bool driven(const Model& model, const Data& data, const State& state, int tree,
              bool controlled) const;

  std::vector<std::uint8_t> hasEquality_;    ///< (trees) 1: connections or welds hold it
  std::vector<std::uint8_t> touched_;        ///< (trees) 1: there are rows of it
  std::vector<std::uint8_t> turns_;          ///< (trees) 1: it may turn far
  std::vector<double> rate_;                 ///< (trees) r
  VectorX change_, bias_, alone_, midstep_;  ///< (nv) scratch
};

}  // namespace softgauss
