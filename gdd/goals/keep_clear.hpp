// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Keep clear: a link does not come nearer to another than a distance.
///
/// For points p_A, p_B of the two that lie opposite each other along the normal n, A to B, at the
/// distance d (ShapeDistances):
///   ḋ = n·u,   u = ṗ_B − ṗ_A,   d̈ ≥ n·(p̈_B − p̈_A) + c
///   ℓ(a) = ½ w Σ max(0, y − n·(p̈_B − p̈_A) − c)²,   y = −k_p (d − d*) − k_d ḋ           (9.22)
/// with c = −Σ r_t (2 t·u + d r_t), r_t = n·(ω × t), over directions t across n in which faces and
/// edges of the two lie there, each turning at its body's ω.
/// The sum is over the points of all pairs of shapes of the two. With w large d̈ ≥ y, and d falls
/// below d* no more than a spring and damper about d* would let it; critically damped, k_d = 2
/// √k_p, it comes to d* and stays. Far away, and on the way out, the cost is zero with all its
/// derivatives. It is convex in a, with a gradient without jumps. What pulls with a force f towards
/// the other ends f/(w k_p) nearer than d*.
///
/// Shapes of links that are joined by a joint, or fixed to each other, are left out.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/model/shape_distances.hpp"
#include "softgauss/gdd/goals/reach.hpp"

namespace softgauss::gdd {

/// A thousand times what a reach weighs.
inline constexpr double kClearWeightPerMass = 1e3 * kReachWeightPerMass;

class KeepClear final : public Goal {
 public:
  /// Geometries of the link and of what it keeps clear of.
  struct Pair {
    int a, b;
  };
  static constexpr double kMetClearance = 1e-3;  ///< the figure counts as met up to here [m]

  std::string link, from;  ///< for the name
  std::vector<Pair> pairs;
  double distance;              ///< d* [m]
  double weight;                ///< w [kg]; default 2500 × referenceMass()
  DefaultWeight defaultWeight;  ///< of w
  double stiffness = 400.0;     ///< k_p [1/s²]
  double damping = 40.0;        ///< k_d [1/s]
  std::shared_ptr<ShapeDistances> shapes;

  /// `from`: a link, or "world" for all that is fixed to it. Throws ModelError where a name is
  /// unknown, the distance is no number ≥ 0, `shapes` is null or no two shapes of the two can move
  /// against each other.
  KeepClear(const Model& model, const std::string& link, const std::string& from, double distance,
            std::shared_ptr<ShapeDistances> shapes);
  /// The pairs of shapes that a goal of the two has; none where they have no shapes or are joined.
  static std::vector<Pair> pairsOf(const Model& model, const std::string& link,
                                   const std::string& from);

  std::string name() const override { return "keep_clear " + link + " from " + from; }
  void weighBeside(double posture) override { defaultWeight.setBeside(posture, weight); }
  void addCost(const GoalContext& context, GoalCost& cost) const override;
  bool concerns(const Model& model, int tree) const override;
  void errors(const GoalContext& context, const ContactForces& contacts,
              std::vector<GoalError>& out) const override;
  /// The least distance of two shapes [m], < 0 where they overlap; nothing where it is not known.
  std::optional<double> clearance(const GoalContext& context) const;

 private:
  /// Calls visit(pair, points).
  template <class Visit>
  void forPairs(const GoalContext& context, Visit&& visit) const;
};

}  // namespace softgauss::gdd
