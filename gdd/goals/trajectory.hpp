// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Targets that move: a place, its velocity and its acceleration at every time, so that a goal asks
/// for
///   a* = p̈* + k_d (ṗ* − ṗ) + k_p (p* − p),   hence  ë + k_d ė + k_p e = 0,  e = p − p*   (9.25)
/// and follows without lag.
///
/// Between knots (tᵢ, pᵢ, vᵢ, aᵢ) a trajectory is the quintic with these values and rates at both
/// ends, which is the motion of least jerk between them (Flash and Hogan 1985). With
/// h = tᵢ₊₁ − tᵢ, s = (t − tᵢ)/h, Δ = pᵢ₊₁ − pᵢ:
///   r = pᵢ + Δ σ(s) + h vᵢ (s − 6 s³ + 8 s⁴ − 3 s⁵) + ½ h² aᵢ (s² − 3 s³ + 3 s⁴ − s⁵)
///          − h vᵢ₊₁ (4 s³ − 7 s⁴ + 3 s⁵) + ½ h² aᵢ₊₁ (s³ − 2 s⁴ + s⁵)
///   σ = 10 s³ − 15 s⁴ + 6 s⁵                                                            (9.26)
/// Where times and places alone are given, the rates at the knots are those that make an integral
/// over the whole time least:
///   minimum jerk   ∫ |r⃛|² dt, at rest at both ends: rates up to the fourth are continuous
///   cubic splines  ∫ |r̈|² dt (Holladay 1957), natural (r̈ = 0 at the ends) or clamped (ṙ = 0)
///                                                                                       (9.27)

#include <memory>
#include <vector>

#include "softgauss/engine/core/types.hpp"

namespace softgauss::gdd {

/// One coordinate at one time.
struct CoordinateMotion {
  double p = 0.0;  ///< [m, rad, or -]
  double v = 0.0;  ///< its rate
  double a = 0.0;  ///< the rate of that
};

/// A place at one time, world axes.
struct PointMotion {
  Vector3 p = Vector3::Zero();  ///< [m]
  Vector3 v = Vector3::Zero();  ///< [m/s]
  Vector3 a = Vector3::Zero();  ///< [m/s²]
};

/// σ of (9.26) with its rates: 0 until `start`, 1 from `start` + `duration` on [s].
CoordinateMotion minimumJerkShare(double time, double start, double duration);

/// Coordinates over time [s]. To add a kind: derive, allocate nothing in at(), and be the same
/// whenever asked.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  virtual int size() const = 0;  ///< how many coordinates
  /// Coordinate i, for every time.
  virtual CoordinateMotion at(double time, int i) const = 0;
  /// Whether it moves, or may, at this time.
  virtual bool movesAt(double time) const = 0;
  /// The first three coordinates.
  PointMotion pointAt(double time) const;
};

/// How places between knots are found.
enum class Interpolation { minimumJerk, naturalSpline, clampedSpline };

/// Through knots; before the first it rests there, after the last there.
class KnotTrajectory final : public Trajectory {
 public:
  /// `times` rise, one for each column of p [m or rad]. Throws ModelError where they do not, or a
  /// number is not finite.
  KnotTrajectory(std::vector<double> times, const MatrixX& p,
                 Interpolation interpolation = Interpolation::minimumJerk);
  /// With rates of its own: v and a as p.
  KnotTrajectory(std::vector<double> times, MatrixX p, MatrixX v, MatrixX a);

  int size() const override { return static_cast<int>(p_.rows()); }
  CoordinateMotion at(double time, int i) const override;
  bool movesAt(double time) const override {
    return times_.front() <= time && time <= times_.back();
  }
  const std::vector<double>& times() const { return times_; }

 private:
  void check(const MatrixX& x) const;

  std::vector<double> times_;
  MatrixX p_, v_, a_;  ///< one column a knot
};

/// Round a circle at constant speed, always: r = c + R (u cos φ + n × u sin φ), φ = φ₀ + 2π f t. u
/// is the axis x of the world across the normal n, or y where x lies along n.
class CircleTrajectory final : public Trajectory {
 public:
  struct Circle {
    Vector3 center = Vector3::Zero();   ///< c [m], world
    double radius = 0.0;                ///< R [m]
    double frequency = 0.0;             ///< f, turns a second [1/s]; < 0: the other way round
    Vector3 normal = Vector3::UnitZ();  ///< n, of any length but zero
    double phase = 0.0;                 ///< φ₀ [rad]
    double startTime = 0.0;             ///< at which it is at the phase [s]
  };
  /// Throws ModelError where a number is not finite, or the normal is zero.
  explicit CircleTrajectory(const Circle& circle);

  int size() const override { return 3; }
  CoordinateMotion at(double time, int i) const override;
  bool movesAt(double) const override { return rate_ != 0.0 && circle_.radius != 0.0; }

 private:
  Circle circle_;
  Vector3 u_, w_;  ///< unit vectors in its plane
  double rate_;    ///< 2π f [rad/s]
};

/// Target of a goal that is a place: where it is and how it moves.
struct PlaceTarget {
  Vector3 p_WTarget = Vector3::Zero();           ///< p* [m]
  Vector3 v_WTarget = Vector3::Zero();           ///< ṗ* [m/s], for who moves p* step by step
  Vector3 a_WTarget = Vector3::Zero();           ///< p̈* [m/s²], likewise
  std::shared_ptr<const Trajectory> trajectory;  ///< of three coordinates; it replaces these

  PlaceTarget() = default;
  explicit PlaceTarget(const Vector3& p_W) : p_WTarget(p_W) {}

  PointMotion targetAt(double time) const {
    return trajectory ? trajectory->pointAt(time) : PointMotion{p_WTarget, v_WTarget, a_WTarget};
  }
  bool targetMovesAt(double time) const {
    return trajectory ? trajectory->movesAt(time)
                      : v_WTarget != Vector3::Zero() || a_WTarget != Vector3::Zero();
  }
  /// The coordinates of p*; null where it follows a trajectory.
  double* restingPlace() { return trajectory ? nullptr : p_WTarget.data(); }
  /// From now on it rests there.
  void restAt(const Vector3& p_W) {
    p_WTarget = p_W;
    v_WTarget = a_WTarget = Vector3::Zero();
    trajectory.reset();
  }
};

}  // namespace softgauss::gdd
