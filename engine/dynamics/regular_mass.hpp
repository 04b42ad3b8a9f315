// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Whether the mass matrix can be inverted in a configuration, and if not, whose fault it is.
///
/// Each pivot of M = LᵀDL is the inertia that a joint feels when all joints beyond it are free. One
/// that is some 10⁻¹⁴ of M_ii, which it is what is left of, holds no digits: M is singular there.

#include <optional>
#include <string>

#include "softgauss/engine/dynamics/inertia.hpp"

namespace softgauss {

/// Pivots below this part of M_ii are zero up to rounding.
inline constexpr double kSingularPivot = 1e-14;

/// The dof, the first from the leaves to the roots, whose pivot is zero up to rounding or so small
/// that its inverse overflows; −1 where there is none. `factor` is left as compute() leaves it.
int singularDof(const TreeMatrix& M, TreeFactor& factor);

/// Why M is singular, as a message tells it.
struct SingularMass {
  std::string element;  ///< "joint 'elbow'"
  std::string link;     ///< where to look in the file
  std::string problem;
};

/// Nothing where M is regular at q.
std::optional<SingularMass> findSingularMass(const Model& model, const VectorX& q);

}  // namespace softgauss
