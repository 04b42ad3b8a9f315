// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "engine/step/data.hpp"

namespace softgauss {

/// Solves for `data.forward.a` once more, with contact normal forces as they are and friction that
/// hardly creeps (constraints/sticking_friction.hpp). Adds to the report's counts; the status is
/// that of the second solve. Does nothing where no contact has friction.
void removeSlip(const Model& model, Data& data) noexcept;

}  // namespace softgauss
