// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Viscous joint damping: force −d v on each dof, so c gains d v. The Euler step treats it
/// implicitly, see integrators/semi_implicit_euler.hpp.

#include "softgauss/engine/core/segment_vectors.hpp"

namespace softgauss {

/// `damping` of every dof, of which these are meant.
inline void addDamping(Segments dofs, const VectorX& damping, const VectorX& v, VectorX& c) {
  for (const Segment s : dofs) part(c, s) += part(damping, s).cwiseProduct(part(v, s));
}

}  // namespace softgauss
