// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Mass, centre of mass and inertia of solid shapes of uniform density.
///
/// Closed forms for the primitives. A mesh is the sum of the signed tetrahedra between its
/// triangles and the origin, which holds for any closed mesh whose triangles face outwards:
///   V = Σ det[a b c]/6,   c = Σ det (a + b + c)/24 / V,
///   ∫ x xᵀ dV = Σ det (a aᵀ + b bᵀ + c cᵀ + (a + b + c)(a + b + c)ᵀ)/120

#include "softgauss/engine/model/shape.hpp"

namespace softgauss {

struct MassProperties {
  double mass = 0.0;                ///< [kg]
  Vector3 com = Vector3::Zero();    ///< centre of mass in G [m]
  Matrix3 I_Gcm = Matrix3::Zero();  ///< central inertia in the axes of G [kg m²]
};

/// Of a solid of the given density [kg/m³]. A plane has no mass. A mesh must enclose a volume: any
/// other with defects (closed_surface.hpp) has a mass that depends on where its origin is.
MassProperties solidOf(const Shape& shape, double density);

}  // namespace softgauss
