// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contacts as the constraints see them: surfaces, frames, relative motion. What bounds their
/// friction, a pyramid or an elliptic cone, is in pyramidal_contact.hpp and elliptic_contact.hpp.
///
/// At a contact of distance r with normal n (from A to B) and tangents t₁, t₂, let y be the
/// relative acceleration of the touching bodies less its bias J̇ v: y_n, y₁, y₂ that of the touching
/// points along n, t₁, t₂, and, with condim 4 and 6, the angular y₃, y₄, y₅ about n, t₁, t₂. J̇ v is
/// that of contact_motion.hpp, where it is known, and is in the references (4.11). The
/// friction coefficients are μ₁ = μ₂ = μ [-] of sliding, μ₃ [m] of torsional and μ₄ = μ₅ [m] of
/// rolling friction.

#include <array>
#include <optional>
#include <vector>

#include "softgauss/engine/constraints/assembly.hpp"
#include "softgauss/engine/constraints/block_jacobian.hpp"
#include "softgauss/engine/constraints/contact_motion.hpp"
#include "softgauss/engine/constraints/impedance.hpp"
#include "softgauss/engine/constraints/law/slip.hpp"
#include "softgauss/engine/constraints/rows.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss {

/// Surface parameters of a pair (3.13): condim and frictions are the larger of the two, impedance
/// parameters their mean by mixWeight, margins the sum. Springs, in newtons, are in series (3.10);
/// where only one surface has a spring, the other is rigid. Where priorities differ, the surface of
/// higher priority gives all but the margin.
Material mixMaterials(const Material& a, const Material& b);

/// The surface of a pair of geometries: its own, or the mix of theirs; its spring in newtons.
Material pairMaterial(const Model& model, int geometryA, int geometryB);

/// The distance beyond the margin within which surfaces at p touch [m]: what lies on something
/// touches it, whichever way its position was rounded. A tower would come to rest cube by cube
/// else, each on what has already sunk in. MuJoCo's contacts have to overlap.
inline double touchingWithin(const Options& options, const Vector3& p_W) {
  constexpr double kRounding = 1e-12;
  return options.constraintModel == ConstraintModel::softgauss
             ? kRounding * p_W.cwiseAbs().maxCoeff()
             : 0.0;
}

/// Two surfaces that touch.
struct Touch {
  double distance = 0.0;             ///< r: that of the contact less the margin, < 0 [m]
  int frictionDim = 0;               ///< condim − 1; 0 when frictionless
  Softness softness;                 ///< of an edge, or of the row along the normal
  double loadStiffening = 1.0;       ///< of it by the load it carries (5.1): (w_A + w_B)/A, ≥ 1
  double inverseMass = 0.0;          ///< A [1/kg]
  double turnedWeight = 0.0;         ///< what turns both bodies by a push here [1/kg]
  bool nearRigid = false;            ///< nobody gave its softness (3.15)
  bool supportsOthers = false;       ///< L > 0: other trees stand on each other here
  double gravity = 0.0;              ///< g [m/s²]
  bool holdsWeight = false;          ///< friction does, holdsWeight()
  std::array<double, 5> friction{};  ///< μ_k of frictionDim directions

  double mu() const { return friction[0]; }  ///< of sliding; 0 when frictionless
};

/// What all contacts of two geometries share. They are neighbours in the set.
struct PairSurface {
  int geometryA = -1, geometryB = -1;
  Material material;       ///< as it acts on their masses
  bool nearRigid = false;  ///< nobody gave it a softness
  int frictionDim = 0;
  Vector3 comA, comB;      ///< centres of mass of their bodies, world [m]
  GeometryPoses poses;     ///< theirs
  double load = 0.0;       ///< L of SupportedMass::mass() [kg]
  double leastLoad = 0.0;  ///< what they bear at least [kg]
  double gravity = 0.0;    ///< g [m/s²]
};

/// Contact i of the scene; nothing where it makes no rows: its bodies cannot move, or are apart.
/// `pair` is that of the contact before, and becomes this one's.
std::optional<Touch> touchAt(const Assembly& in, int i, PairSurface& pair);

/// A contact that made rows.
struct ContactRows {
  int contact = 0;                   ///< index into ContactSet::contacts
  int geometryA = 0, geometryB = 0;  ///< that touch
  int bodyA = 0, bodyB = 0;          ///< theirs
  int place = 0;                     ///< among the contacts of the two
  int row = 0;                       ///< first row
  Matrix3 R_WC;                      ///< columns n, t₁, t₂
  int frictionDim = 0;               ///< condim − 1; 0 when frictionless
  std::array<double, 5> friction{};  ///< μ_k
  double loadStiffening = 1.0;       ///< Touch::loadStiffening
  double regularisationScale = 1.0;  ///< ρ (5.7), 1 where it does not stick
  double share = 1.0;                ///< of J̇ v along the tangents
  bool alongGravity = false;         ///< t₁ is
};

/// Contacts of one kind, and how they move.
class ContactBlocks {
 public:
  /// Of row i of these contacts.
  RowKey name(int row) const {
    const ContactRows& m = contactsWithRows_[idx(contactOfRow_[idx(row)])];
    return {m.geometryA, m.geometryB, m.place, row - m.row};
  }
  /// Contacts with rows; contact i starts at row contactsWithRows()[i].row.
  const std::vector<ContactRows>& contactsWithRows() const { return contactsWithRows_; }
  void appendCouplings(std::vector<Segment>& segments, std::vector<int>& setEnd) const {
    jacobian_.appendCouplings(segments, setEnd);
  }
  void appendPairs(std::vector<std::pair<int, int>>& pairs) const { jacobian_.appendPairs(pairs); }
  void reserveColumns() { jacobian_.reserveColumns(); }
  /// Velocities ẏ, or forces and moments, in the frame of a contact.
  using FrameVector = std::array<double, 6>;
  /// Block i: from a to y of contact i.
  BlockJacobian& jacobian() { return jacobian_; }
  const BlockJacobian& jacobian() const { return jacobian_; }
  /// The first three of a frame's six numbers in world axes, and the last three.
  Vector3 linearInWorld(int i, const FrameVector& y) const {
    return contactsWithRows_[idx(i)].R_WC * Vector3(y[0], y[1], y[2]);
  }
  Vector3 angularInWorld(int i, const FrameVector& y) const {
    return contactsWithRows_[idx(i)].R_WC * Vector3(y[3], y[4], y[5]);
  }
  /// Place in contactsWithRows() of the contact that has this row.
  int contactOfRow(int row) const { return contactOfRow_[idx(row)]; }
  /// A body that the row moves.
  int bodyOf(const Model&, int row) const { return jacobian_.bodyOf(contactOfRow(row)); }

  std::size_t bytes() const {
    return jacobian_.bytes() + bytesOfAll(contactsWithRows_, contactOfRow_);
  }

 protected:
  /// How a contact moves, in its frame.
  struct BlockMotion {
    FrameVector velocity{};  ///< ẏ
    FrameVector bias{};      ///< J̇ v
  };
  void clearBlocks() {
    jacobian_.clear();
    contactsWithRows_.clear();
  }
  /// The block of contact i, of the pair, whose rows begin at `row`.
  BlockMotion addBlock(const Assembly& in, int i, const PairSurface& pair, const Touch& touch,
                       int row);
  /// |(μ_k ẏ_k)|, of all directions of friction in the units of the normal [m/s].
  static double slipSpeed(const Touch& touch, const FrameVector& velocity);
  /// How soft the last block is: as it is, or harder where it sticks (5.7).
  Softness soften(const Assembly& in, const Touch& touch, const FrameVector& velocity);
  /// How the last block slides (5.8).
  Slip slipOf(const Assembly& in, const Touch& touch, const Softness& soft,
              const BlockMotion& moves) const;
  /// What of s the last acceleration met by what rests on the contact, t₋ of (5.8); `brakes` is β.
  double metLast(const Assembly& in, const BlockMotion& moves, const Slip& slip,
                 double brakes) const;
  /// Contact of each of `rows` rows.
  void indexRows(std::size_t rows);
  /// call(i), an int, of the contacts to which these rows belong.
  template <class F>
  void forEachContact(const RowSelection& rows, F&& call) const {
    for (const Segment s : rows.segments()) {
      if (s.begin == s.end) continue;
      for (int i = contactOfRow(s.begin); i <= contactOfRow(s.end - 1); ++i) call(i);
    }
  }

  BlockJacobian jacobian_;  ///< block i: y of contact i
  std::vector<ContactRows> contactsWithRows_;
  std::vector<int> contactOfRow_;
};

}  // namespace softgauss
