// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Analytical inverse dynamics, equations (14) and (15) of the paper:
///
///   g(a) = M a + c + Jᵀ∇s(J a − a_ref)      explicit: no iteration                     (1.2)
///   P    = ∂g/∂a = M + Jᵀ∇²s J               symmetric positive definite                (1.3)

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// tau ← g(a) at the state of the stages in `data`, those of computeBodyStages(). Leaves the rows
/// evaluated at a. Returns badInput where a has another size than (nv), data.stats.badInput tells
/// it, and notFinite where a is not finite; tau is then as it was.
SolveStatus inverseDynamics(const Model& model, const VectorX& a, Data& data, VectorX& tau);

/// P ← curvature of the cell that the rows were last evaluated in. Of stages that computeStages()
/// has made; false, with P as it was, after a step on bodies, which leaves no matrices.
bool inverseDynamicsJacobian(Data& data, TreeMatrix& P);

}  // namespace softgauss
