// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How soft a constraint is, and how a surface rubs. Parameters only, in MuJoCo's terms; their
/// meaning is computed in constraints/impedance.hpp and constraints/contact.hpp.

#include <optional>

namespace softgauss {

/// Reference spring-damper of a hard row, given directly: r̈ = −damping ṙ − stiffness r far inside
/// the constraint, whatever the masses. MuJoCo's negative solref.
struct ReferenceSpring {
  double stiffness = 0.0;  ///< [1/s²], ≥ 0
  double damping = 0.0;    ///< [1/s], ≥ 0
  bool operator==(const ReferenceSpring&) const = default;
};

/// Impedance of a soft constraint. With r the constraint's distance or violation
/// (docs/theory/README.md):
///   reference acceleration  a_ref = −b ṙ − k d(r) r,   regulariser  R = (1 − d)/d · A
/// where d(r) rises from dMin at r = 0 to dMax at |r| = width along a power curve. Defaults are
/// MuJoCo's (solref 0.02 1, solimp 0.9 0.95 0.001 0.5 2).
struct Impedance {
  double timeConstant = 0.02;                  ///< [s] of the reference spring-damper; > 0
  double dampingRatio = 1.0;                   ///< [-] 1 is critical
  double dMin = 0.9;                           ///< impedance at zero violation, in (0, 1)
  double dMax = 0.95;                          ///< impedance at |r| ≥ width, in (0, 1)
  double width = 0.001;                        ///< [m or rad]
  double midpoint = 0.5;                       ///< inflection of the curve, in (0, 1)
  double power = 2.0;                          ///< ≥ 1
  std::optional<ReferenceSpring> direct = {};  ///< in place of timeConstant and dampingRatio
  bool operator==(const Impedance&) const = default;
};

/// Softness of a contact in physical units, in place of its Impedance (3.8): a spring and a damper
/// that make the normal force, the same for every friction, mass and cone. Either way of giving the
/// spring, and of giving the damper, excludes the other.
struct ContactSpring {
  double stiffness = 0.0;  ///< [N/m]; 0: by restDepth
  double restDepth = 0.0;  ///< [m] overlap of one contact under its body's own weight; 0: not used
  double damping = 0.0;    ///< [N s/m]
  double dampingRatio = 0.0;  ///< [-] with the body's own mass, 1 is critical
  bool operator==(const ContactSpring&) const = default;
};

/// Below this coefficient a cone degenerates: the contact is frictionless.
inline constexpr double kSmallestFriction = 1e-5;

/// Surface parameters of a geometry; a pair is mixed by the rules of constraints/contact.hpp.
struct Material {
  double slidingFriction = 1.0;      ///< μ, Coulomb [-]
  double torsionalFriction = 0.005;  ///< [m], read by condim 4 and 6
  double rollingFriction = 0.0001;   ///< [m], read by condim 6
  int condim = 3;                    ///< 1 frictionless, 3 sliding, 4 and torsional, 6 and rolling
  double margin = 0.0;               ///< [m] a contact makes rows where distance < margin
  int priority = 0;                  ///< of two surfaces, the higher one alone decides (3.13)
  double mixWeight = 1.0;            ///< ≥ 0, share of this surface in the pair's impedance
  Impedance impedance;
  std::optional<ContactSpring> spring = {};  ///< in place of the impedance
  bool operator==(const Material&) const = default;
};

}  // namespace softgauss
