// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How a contact moves, and what that adds to the acceleration of its bodies against each other.
///
/// The point of contact is of neither body: what rolls or spins on the ground touches it with ever
/// other points. It runs along at ṗ, and so does the place at which the bodies' velocities are
/// compared, in the frame C of the flat one, which turns with it at ω_C:
///
///   J̇ v = a_B − a_A + ω_B × (ṗ − v_B) − ω_A × (ṗ − v_A) − ω_C × (v_B − v_A)             (4.10)
///   angular:  α_B − α_A − ω_C × (ω_B − ω_A)
///
/// with v, a and α of the bodies at p where v̇ = 0. What touches the flat one tells ṗ. It turns
/// against it at ω, its deepest place runs along its surface at ν, and p is half the distance d
/// from there, midway between the surfaces. With n away from the flat one
///
///   ṗ = v + ν + ½ d ω × n − ½ ḋ n
///
///   ν = ρ ω × n                                 of a sphere or capsule of radius ρ
///   ν = 0                                       of a corner, of boxes and meshes
///   ν = −a·(n × (ω × n))/|a × n|² a × s         of a rim
///
/// a the axis of a cylinder, s from its centre to the place on its rim. Of two faces that lie on
/// each other the one whose edge is nearer has the corner. Of corners of meshes J̇ v counts along
/// the tangents alone: a wheel of many faces would be lifted by ω² r of each.

#include <optional>

#include "softgauss/engine/constraints/contact_set.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss {

struct ContactBias {
  Motion rate;  ///< J̇ v, world axes [m/s², rad/s²]
  /// Of corners of meshes: J̇ v along the normal, which `rate` is without [m/s²].
  std::optional<double> leftOut;
  /// How deep it counts whatever presses, and where its load presses it so deep [m]: 0.3 of the
  /// radius of a ball or capsule, 0.1 and 0.3 of the height of a rim's middle above the place,
  /// which turns the faster the flatter it lies; a corner at any depth.
  double biasDepth = 0.0, loadedBiasDepth = 0.0;
};

/// Where the two geometries of a contact are.
struct GeometryPoses {
  Transform X_WA, X_WB;
};
GeometryPoses posesOf(const Model& model, const Kinematics& kinematics, const Contact& contact);

/// Whether A is the flat one, or B, of two faces the one whose edge is farther; nothing where
/// neither surface is flat.
std::optional<bool> flatIsA(const Model& model, const GeometryPoses& at, const Contact& contact);

/// Nothing where J̇ v is not known: neither surface is flat; or, in a step that knows its start
/// alone, a body tilts by more than 0.3 rad or the place on a rim goes round by more than 1.
std::optional<ContactBias> contactBias(const Model& model, const Kinematics& kinematics,
                                       const GeometryPoses& at, const Contact& contact);
inline std::optional<ContactBias> contactBias(const Model& model, const Kinematics& kinematics,
                                              const Contact& contact) {
  return contactBias(model, kinematics, posesOf(model, kinematics, contact), contact);
}

}  // namespace softgauss
