// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

/// Solves for `data.forward.a` once more, with friction that hardly creeps, bounded by the normal
/// forces that contacts have there (constraints/no_slip_friction.hpp). Adds to the report's
/// counts. Where the second solve does not converge, the first solution stands. Does nothing where
/// no contact has friction.
void removeSlip(const Model& model, Data& data) noexcept;

}  // namespace softgauss
