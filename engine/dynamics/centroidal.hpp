// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Centroidal momentum of one robot: what the sum of its external forces can change.
///
///   h = (p; k) = A v,     ḣ = A v̇ + ḣ⁰                                                   (2.8)
/// p is the linear momentum and k the angular momentum about the centre of mass C, world axes. With
/// I^c_b the composite inertia of body b's subtree about O, and spatial vectors about O,
///   column i of A:   (moment, force) = I^c_b(i) S_i,   p = force,   k = moment + (O − C) × force
///   ḣ⁰:              Σ_b (I_b A⁰_b + V_b ×* I_b V_b), moved from O to C in the same way
/// That C moves adds nothing to k̇: it would add −v_C × p, and p is m v_C. Rotor inertias (armature)
/// are not counted. (Orin, Goswami, Lee 2013.)

#include "softgauss/engine/dynamics/inertia.hpp"

namespace softgauss {

struct Centroidal {
  double mass = 0.0;               ///< [kg]
  Vector3 p_WC = Vector3::Zero();  ///< centre of mass [m]
  Vector3 v_WC = Vector3::Zero();  ///< its velocity [m/s]
  MatrixX A;                       ///< (6 × nv) rows of p, then of k; zero at other robots' dofs
  Vector6 momentum = Vector6::Zero();  ///< p [kg m/s], k [kg m²/s]
  Vector6 bias = Vector6::Zero();      ///< ḣ⁰: ḣ at v̇ = 0 [N, N m]
};

/// Of the bodies whose Body::robot is `robot`; reads the poses, velocities and inertias.
void computeCentroidal(const Model& model, const Kinematics& kinematics, const MassMatrix& inertia,
                       int robot, Centroidal& result);

}  // namespace softgauss
