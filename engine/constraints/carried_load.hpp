// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a contact carries besides its own two bodies, from the graph of contacts alone (T.80).
///
/// Trees that touch each other, not counting the world, are an island. A tree T on a free base
/// counts in it with the largest inertia that a contact feels on one of its bodies, others with
/// none,
///   m_T = min(mass of T, max over touched bodies B of 1/w_B)
/// and a contact between the trees S and T has to carry
///   L = Σ over the island of m  −  min(m_S, m_T)        (with the world, or in one tree: − m_T)
/// Its regulariser R = (1 − d)/d A then takes A = min(w_A + w_B, 1/L). So a light body under a
/// heavy one is as hard as its load wants, and a tree that touches nothing but the world and itself
/// is as it was: L = 0. L depends on the contacts of this instant and on constants; it costs
/// O(contacts).

#include <vector>

#include "engine/constraints/contact_set.hpp"
#include "engine/constraints/inverse_weight.hpp"

namespace softgauss {

class CarriedLoad {
 public:
  void assemble(const Model& model, const ContactSet& contacts, const InverseWeights& weights);
  /// L of a contact [kg].
  double of(const Model& model, const Contact& contact) const;

 private:
  int root(int tree);

  bool any_ = false;            ///< two trees touch
  std::vector<int> parent_;     ///< of a tree in its island, towards the one that stands for it
  std::vector<double> mass_;    ///< m_T [kg]
  std::vector<double> island_;  ///< Σ m, of each tree's island [kg]
};

}  // namespace softgauss
