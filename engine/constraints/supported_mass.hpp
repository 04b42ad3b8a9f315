// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a contact or an equality constraint carries besides its own two bodies, from the graph of
/// contacts and of ties, which are connections and welds that do not bounce
/// (underdampedReference()), alone (5.1).
///
/// Trees that touch or are tied to each other, not counting the world, are an island. A tree T on a
/// free base counts in it with the largest inertia that a contact or equality constraint feels on
/// one of its bodies,
///   m_T = min(mass of T, max over touched and tied bodies B of 1/w_B)
/// one on a fixed base over tied bodies only: what touches it stands on it. What stands on the
/// world passes its load down: the layer of a tree is the number of contacts and equality
/// constraints between it and the world, and each of its n_T ones with the layer below takes an
/// equal share,
///   P_T = m_T + Σ (M_U + P_U − m_U)/n_U,   over those with trees U of the layer above, of mass M_U
/// One between the trees S and T has to carry
///   L = max(largest m of the island,  P of the one that is farther from the world)
/// of two that are equally far the larger P; with the world, or in one tree,
///   L = max(largest m of the island's others,  P_T − m_T)
/// Its regulariser R = (1 − d)/d A then takes A = min(w_A + w_B, 1/L). So a light body under a
/// heavy one is as hard as its load wants, and a tree that touches nothing but the world and itself
/// is as it was: L = 0. L depends on the contacts of this instant and on constants; it costs
/// O(contacts + ties).
///
/// A weld holds what it carries against turning too. Of the body B that gives m_T, c_T is the
/// centre of mass and I_T = 1/w^r_B. About the weld's origin p, in the middle where frames are
/// apart, that is I_T + m_T |c_T − p|², what is passed down adds up as P does, and I, the largest
/// of both kinds as L is, bounds the A of its three rows of rotation: A = min(w^r_A + w^r_B, 1/I)
/// (5.5)
///
/// What stands on a light foot or hangs from a light hook through joints is of the same tree, and
/// no body of it tells its weight: what a contact or equality constraint feels of the foot is what
/// turns it about its ankle. So the n_T contacts and equality constraints that hold a tree T, no
/// single free body, to others share it,
///   L ← max(L, mass of T/ties)     of an equality constraint, where T floats                 (5.2)
///   L ← max(L, mass of T/(5 n_T))  of a contact                                          (5.3)
/// and m_T is at least that of (5.3), on a fixed base too: a rail bears none of what slides on
/// it. Contacts count to a fifth: those of robots in use are as hard by their feet alone, and
/// hardly change.

#include <vector>

#include "softgauss/engine/constraints/contact_set.hpp"
#include "softgauss/engine/constraints/inverse_weight.hpp"
#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss {

/// A of what carries a load: the bodies' weight, or less.
inline double cappedInverseMass(double weight, double load) {
  return load * weight > 1.0 ? 1.0 / load : weight;
}

/// What a contact bears at least of robots, where so many contacts and equality constraints hold
/// that of A, and that of B, to others (5.3) [kg].
double contactShare(const Model& model, int bodyA, int bodyB, int heldA, int heldB);

class SupportedMass {
 public:
  void assemble(const Model& model, const Kinematics& kinematics, const ContactSet& contacts,
                const InverseWeights& weights);
  /// L between bodies of which a contact or an equality constraint is [kg].
  double mass(const Model& model, int bodyA, int bodyB) const;
  /// Of a tree of several bodies that floats, what an equality constraint bears of it (5.2) [kg]; 0
  /// of others.
  double equalityShare(const Model& model, int bodyA, int bodyB) const;
  /// What a contact bears at least of robots (5.3) [kg].
  double contactShare(const Model& model, int bodyA, int bodyB) const;
  /// Whether an equality constraint holds one of the bodies' trees to another, or to the world.
  bool isTied(const Model& model, int bodyA, int bodyB) const;
  /// I between bodies that a weld ties, about p_W [kg m²].
  double inertia(const Model& model, int bodyA, int bodyB, const Vector3& p_W) const;

 private:
  /// Mass, its first moment [kg m] and its second one, with what turns besides [kg m²].
  struct Load {
    double mass = 0.0;
    Vector3 moment = Vector3::Zero();
    double rotational = 0.0;

    /// Adds one of so many parts of the other.
    void add(const Load& other, double parts);
    /// Of one that has less mass than m, all of it by as much.
    void raiseTo(double m);
    double about(const Vector3& p) const;
  };
  /// How many contacts and equality constraints hold a tree to others.
  struct Supports {
    int contacts = 0, equalities = 0;
    int all() const { return contacts + equalities; }
  };
  /// A contact or equality constraint as one of its two trees sees it.
  struct Link {
    int other = -1;  ///< the other tree
    int next = -1;   ///< the tree's next in `links_`
  };
  /// The trees of the two largest m of an island, −1 without.
  struct Largest {
    int first = -1, second = -1;
  };
  /// What a contact or equality constraint has to carry: a tree of the island, and what one or the
  /// other of its own trees passes down, less itself where `excludeSelf`; −1 where there is none.
  struct Supported {
    int largest = -1, passing = -1, other = -1;
    bool excludeSelf = false;
  };

  /// The largest `size` of what is carried.
  template <class F>
  double mostOf(const Supported& supported, F&& size) const;
  int root(int tree);
  double massOf(int tree) const { return tree < 0 ? 0.0 : self_[idx(tree)].mass; }
  void weigh(const Model& model, const Kinematics& kinematics, const ContactSet& contacts,
             const InverseWeights& weights);
  void findLayers();
  void passDown(const Model& model);
  Supported between(const Model& model, int bodyA, int bodyB) const;

  bool any_ = false;                  ///< two trees touch, or are tied
  Vector3 origin_ = Vector3::Zero();  ///< of moments (world) [m]
  std::vector<Supports> supports_;    ///< of each tree
  std::vector<int> parent_;       ///< of a tree in its island, towards the one that stands for it
  std::vector<Load> self_;        ///< m_T, c_T, I_T
  std::vector<Load> supported_;   ///< P_T
  std::vector<Largest> largest_;  ///< of the island that a tree stands for
  std::vector<int> island_;       ///< the tree that stands for each tree's island
  std::vector<int> layer_;        ///< 1 on the world; 0 where nothing leads to the world
  std::vector<int> order_;        ///< trees that stand on the world, by layer
  std::vector<int> head_;         ///< a tree's first in `links_`, −1 without
  std::vector<Link> links_;
};

}  // namespace softgauss
