// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Whether what moves is what was solved.

#include "softgauss/engine/step/step_control.hpp"

namespace softgauss {

/// The largest |moved − a| over max(|a|∞, 1), of accelerations, a of the solve, or of `aim` where a
/// control has found one. Trees that take parts of their own do not count, nor those that are
/// followed by themselves, where `follows`, but for those that a control acts on.
double deviation(const Model& model, const Data& data, bool follows, const StepControl* control,
                 const VectorX& moved, const VectorX* aim);

}  // namespace softgauss
