// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What holds a light body that swings between connections faster than a step follows.
///
/// Connections that pull at levers a from the centre of mass with forces f turn the body back as
/// the string turns back a bead; so does a joint, with what the connections of all bodies beyond it
/// pull. With its inertia I, and F what all rows do to it together,
///   K = η Σ κ (1 − â âᵀ),   κ = ½ (|a||f| + a·f),   η = clamp(5 (1 − |F|/Σ |f|), 0, 1)
///   ω² = ½ tr(I⁻¹ K)                                                                      (6.8)
/// F is what its own motion and weight take, the rest goes through it. A light body that
/// bears a great load swings fast, and where h ω > 2 a step that takes the levers where they are at
/// its start makes energy of it. At the step's end each has gone on by h ω⁺ × a, and its moment is
/// less by h η κ ω⁺. So from half a radian a step on each connection holds the body against the
/// other one, with ω_r, α_r the turning of the one against the other:
///   s = ½ C |(1 − â âᵀ)(h α_r + δ ω_r)|²/h,      C = h η κ (1 − ¼/(h ω)²)                 (6.9)
/// With δ = 1 that is the friction C ω_r⁺ of a pin whose radius is the way of the lever in a step;
/// with δ = 0 an inertia against turning, and what turns evenly goes on. But C comes and goes with
/// the forces, and an inertia that comes while the body turns has energy that it never had. Forces
/// of a string change slowly, unless it turns far in a step, those of what else touches the body at
/// once:
///   δ = min(1, 0.1 + (4 h |ω_r|)⁴ + 5 |F − Σ f|/Σ |f|)
/// the last of the root of the body's tree.
///
/// *The other body* has a lever a_o too, from its centre of mass or, in a tree that does not float,
/// from its joint. Where that is shorter, its turning says little of the string's: a bead that is
/// threaded at its centre turns as it likes. With λ = min(1, |a_o|/|a|) the body is held against it
/// by λ C and δ, and by (1 − λ) C and λ δ, λ of its own lever, against what pulls hardest on the
/// other side of the bead. Where nothing does, by C and λ δ against the other body alone.
///
/// f and F are those of the last solve (State::connectionForces), so that these rows are in the one
/// solve of the step, which goals see; where none are known, as in the first solve of a run,
/// nothing is held. Momentum is kept, and what turns together is as it was. Trees that do not
/// float are not held: their joints have inertias of their own.

#include <vector>

#include "softgauss/engine/constraints/assembly.hpp"
#include "softgauss/engine/constraints/block_rows.hpp"

namespace softgauss {

class GeometricStiffness : public BlockRows {
 public:
  void assemble(const Assembly& in);
  /// How many bodies the rows hold.
  int heldBodies() const { return heldBodies_; }

  std::size_t bytes() const {
    return BlockRows::bytes() +
           bytesOfAll(connectionForces_, bodyStiffness_, otherLoadRatio_, treeForce_);
  }

 private:
  /// What a connection or a joint does to one of its bodies; the next one or the last is what it
  /// does to the other.
  struct ConnectionForce {
    int body, other;
    Vector3 a_W;    ///< lever [m]
    Vector3 f_W;    ///< [N]
    double moment;  ///< κ ≥ 0 [N m]
  };
  /// Of a body of a floating tree.
  struct BodyStiffness {
    Matrix3 K = Matrix3::Zero();    ///< Σ κ (1 − â âᵀ) [N m/rad]
    double force = 0.0;             ///< Σ |f| [N]
    Vector3 sum = Vector3::Zero();  ///< Σ f [N]
    double share = 0.0;             ///< η (1 − ¼/(h ω)²), ≤ 0 where a step follows it
  };
  void findConnectionForces(const Assembly& in);
  /// How fast body b swings, K being that of its connections: `share`.
  void findShare(const Assembly& in, int b);
  /// f_W pulls A at one point and −f_W B at the other.
  void addConnectionForces(const Assembly& in, int bodyA, int bodyB, const Vector3& p_WA,
                           const Vector3& p_WB, const Vector3& f_W);
  void addJointForces(const Assembly& in, const Tree& tree);
  /// The pull on the other side of a pull's other body; the hardest of several, null if none.
  const ConnectionForce* neighbourAcross(const Model& model, std::size_t pull) const;
  void addRows(const Assembly& in, std::size_t pull, double share, double otherLoadRatio);
  /// `leverRatio`: λ of the other body.
  void addRows(const Assembly& in, const ConnectionForce& pull, int other, double share,
               double leverRatio, double otherLoadRatio);

  std::vector<ConnectionForce> connectionForces_;
  std::vector<BodyStiffness> bodyStiffness_;  ///< of each body
  std::vector<double> otherLoadRatio_;        ///< of each tree: 5 |F − Σ f|/Σ |f| of its root
  std::vector<Vector3> treeForce_;            ///< of each tree: F of its root [N]
  int heldBodies_ = 0;
};

}  // namespace softgauss
