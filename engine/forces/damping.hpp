// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Viscous joint damping: force −d v on each dof, so c gains d v. The Euler step treats it
/// implicitly, see integrators/semi_implicit_euler.hpp.

#include "softgauss/engine/core/types.hpp"

namespace softgauss {

/// `damping` of every dof.
inline void addDamping(const VectorX& damping, const VectorX& v, VectorX& c) {
  c += damping.cwiseProduct(v);
}

}  // namespace softgauss
