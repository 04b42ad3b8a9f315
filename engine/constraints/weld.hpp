// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Welds: a frame F_A of body A and a frame F_B of body B coincide. Six rows each.
///
/// Three rows are those of a connection of the origins. Three are the vector part ē of the
/// quaternion that turns F_B into F_A (half the angle between them, where it is small), times a
/// length s, the torque scale:
///   e = q̄_B q_A = (e₀, ē),   r = s ē,   J = ½ s (e₀ 1 + [ē]×) R_WAᵀ (J_ωA − J_ωB)
///   J̇ v = ½ s [(e₀ 1 + [ē]×) R_WAᵀ(ω̇ − ω_A × ω) − ½ |ω|² ē],   ω = ω_A − ω_B             (4.4)
///   x = J a − a_ref,   a_ref = −b J v − k d r − J̇ v,   s(x) = ½ D x²
/// All six rows share d, of the length of their six distances; A is the translational inverse
/// weight of the two bodies in three rows, the rotational one in the others, or less where the weld
/// carries more than they are (5.1), (5.5). Bodies that cannot
/// turn have the first three rows only.

#include "softgauss/engine/constraints/assembly.hpp"
#include "softgauss/engine/constraints/block_rows.hpp"

namespace softgauss {

class WeldRows : public BlockRows {
 public:
  void assemble(const Assembly& in);
};

}  // namespace softgauss
