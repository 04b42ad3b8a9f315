// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a contact carries besides its own two bodies, from the graph of contacts alone (T.80).
///
/// Trees that touch each other, not counting the world, are an island. A tree T on a free base
/// counts in it with the largest inertia that a contact feels on one of its bodies, others with
/// none,
///   m_T = min(mass of T, max over touched bodies B of 1/w_B)
/// What stands on the world passes its load down: the layer of a tree is the number of contacts
/// between it and the world, and each of its n_T contacts with the layer below takes an equal
/// share,
///   P_T = m_T + Σ P_U/n_U,   over the contacts with trees U of the layer above
/// A contact between the trees S and T has to carry
///   L = max(largest m of the island,  P of the one that is farther from the world)
/// of two that are equally far the larger P; with the world, or in one tree,
///   L = max(largest m of the island's others,  P_T − m_T)
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
  /// A contact as one of its two trees sees it.
  struct Link {
    int other = -1;  ///< the other tree
    int next = -1;   ///< the tree's next contact in `links_`
  };
  /// The two largest m of an island [kg].
  struct Largest {
    double first = 0.0, second = 0.0;
  };

  int root(int tree);
  void weigh(const Model& model, const ContactSet& contacts, const InverseWeights& weights);
  void findLayers();
  void passDown();

  bool any_ = false;              ///< two trees touch
  std::vector<int> parent_;       ///< of a tree in its island, towards the one that stands for it
  std::vector<double> mass_;      ///< m_T [kg]
  std::vector<double> passed_;    ///< P_T [kg]
  std::vector<Largest> largest_;  ///< of the island that a tree stands for
  std::vector<int> island_;       ///< the tree that stands for each tree's island
  std::vector<int> layer_;        ///< 1 on the world; 0 where no contact leads to the world
  std::vector<int> order_;        ///< trees that stand on the world, by layer
  std::vector<int> head_;         ///< a tree's first contact in `links_`, −1 without
  std::vector<Link> links_;
};

}  // namespace softgauss
