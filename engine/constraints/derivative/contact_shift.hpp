// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How place, frame and distance of a contact change as its bodies are moved a little.
///
/// A body that is moved moves the point p of it by t and turns by θ. Of a flat surface F, a plane
/// or the face of a box, and what touches it, O, with n̂ from F to O and θ = θ_O − θ_F,
///
///   δd = n̂·(t_O + ν − t_F),   δn̂ = θ_F × n̂,   δp = t_O + ν + ½ d θ × n̂ − ½ δd n̂           (D.6)
///
/// with ν of (4.10) for θ in place of ω, which is along the surface but for points of a rim beside
/// its lowest one. Of two spheres of centres c, L apart, with δc = t + θ × (c − p),
///
///   δd = n·(δc_B − δc_A),   δn = (1 − n nᵀ)(δc_B − δc_A)/L,   δp = δc_A + (ρ_A + ½ d) δn + ½ δd n
///
/// The frame turns by w = n × δn + s n. Its first tangent lies along u = t̂ − n (n·t̂) of a wished
/// direction t̂, which the capsule or the flat body carries along, or of an axis of the world:
///
///   s = (δt̂·t₂ − (n·t̂)(δn·t₂))/|u|
///
/// Of other pairs of shapes δd, δn, δp and δt̂ are measured: both bodies move as A does, and then B
/// against A.

#include <optional>
#include <utility>

#include "softgauss/engine/constraints/contact_set.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss {

/// A small motion of a body as its point at a contact sees it.
struct PointMotion {
  Vector3 linear = Vector3::Zero();   ///< t
  Vector3 angular = Vector3::Zero();  ///< θ
};

class ContactShift {
 public:
  struct Change {
    Vector3 p = Vector3::Zero(), n = Vector3::Zero();  ///< δp, δn of Contact::n_W
    Vector3 turn = Vector3::Zero();                    ///< w
    double distance = 0.0;
  };

  /// How δd, δn, δp and δt̂ of Contact::tangent_W, in this order, follow t and θ of B about p, where
  /// A stays.
  using Measured = Eigen::Matrix<double, 10, 6>;

  /// Nothing where the pair of shapes has no closed form here.
  static std::optional<ContactShift> of(const Model& model, const Kinematics& k, const Contact& c,
                                        bool alongGravity);
  static ContactShift of(const Model& model, const Kinematics& k, const Contact& c,
                         bool alongGravity, const Measured& measured);

  Change change(const PointMotion& A, const PointMotion& B) const;

  /// Whether J̇ v of (4.10) may be known.
  bool hasFlat() const { return !round_; }
  bool flatIsA() const { return flatIsA_; }
  /// ν for a turning by `angular` of O against F.
  Vector3 along(const Vector3& angular) const;
  /// Its change where n̂ changes by dn, the turning by dAngular, O is moved by `moved`, p by dp and
  /// d by dDistance.
  Vector3 alongChange(const Vector3& angular, const Vector3& dAngular, const Vector3& dn,
                      const PointMotion& moved, const Vector3& dp, double dDistance) const;
  const Vector3& normal() const { return n_; }  ///< n̂; where both are round n
  double distance() const { return d_; }

 private:
  enum class Wish { world, ofA, ofB, measured };
  /// What a ball or capsule is about: a point or a segment.
  struct Core {
    Vector3 centre = Vector3::Zero();  ///< the point nearest to the other, c − p
    Vector3 axis = Vector3::Zero();
    bool slides = false;  ///< c is no end of it
  };
  static Core coreOf(const Shape& shape, const Transform& X_WG, const Vector3& p_WC,
                     const Vector3& fromContact);
  /// False where the two lie alongside.
  bool setRound(const Geometry& A, const Transform& X_WA, const Geometry& B, const Transform& X_WB,
                const Contact& c, const Vector3& wished);
  /// δc of both.
  std::pair<Vector3, Vector3> centresMove(const PointMotion& A, const PointMotion& B) const;
  void setTangent(const Contact& c, Wish carriedBy, const Vector3& wished);
  void setRim(const Model& model, const Kinematics& k, const Contact& c, int geometry);
  void setOther(const Model& model, const Kinematics& k, const Contact& c, int geometry);
  double spin(const Change& change, const Vector3& wishedMoves) const;
  Change measuredChange(const PointMotion& A, const PointMotion& B) const;

  std::optional<Measured> measured_;
  bool round_ = false, flatIsA_ = true, rim_ = false;
  Vector3 n_ = Vector3::UnitZ();
  double d_ = 0.0;
  double radius_ = 0.0;  ///< ρ of O, or of A where both are round
  double apart_ = 1.0;   ///< L
  double cosine_ = 0.0;  ///< of the angle between two cores
  Core coreA_, coreB_;
  Vector3 axis_ = Vector3::UnitZ(), fromCentre_ = Vector3::Zero();  ///< of a rim: a, s of (4.10)
  Vector3 centre_ = Vector3::Zero();  ///< of a rim: its cylinder's centre less p
  std::optional<Matrix3> ellipsoid_;  ///< W of O (ellipsoid_point.hpp)
  Wish wish_ = Wish::world;
  Vector3 wished_ = Vector3::UnitY(), contactNormal_ = Vector3::UnitZ(), t2_ = Vector3::UnitX();
  double wishedLength_ = 1.0;  ///< |u|
};

}  // namespace softgauss
