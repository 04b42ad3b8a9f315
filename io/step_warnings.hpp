// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What the step cannot carry, told before the first one: springs and references that are faster
/// than it, surfaces that it softens, shapes that overlap at the start. Each warning names the
/// joint, the surface or the pair, with its number against that of the step, and says what to try.
///
/// With w_i the inverse inertia of a dof (2.7) and h the step:
///   spring       h √(k w_i) > 1          it swings by more than a radian in a step
///   damping      h d w_i > 100           it stops the joint within the step, whatever drives it
///   effort       h² u w_i > π            it turns by half a turn in the first step
///   reference    a bounce too fast for the step is clamped (3.5); where rows are
///   explicit
///                it is taken as it is, and grows where h² K + 2 h B > 4
///   time constant below 2 h              (3.2): it counts as 2 h
///   light body   h ω > 1   between its equality constraints it swings by more than a radian a step
///   step         from 50 times the usual 2 ms on, that alone in place of all of these
///   `implicit`   d w_i < 0.1/s            a joint among others that gain energy by it

#include <string>
#include <vector>

#include "softgauss/engine/constraints/contact_set.hpp"
#include "softgauss/engine/model/model.hpp"

namespace softgauss::io {

/// Shapes that overlap by less at the start are not told of [m].
inline constexpr double kToldOverlap = 1e-3;

/// `touching` are the contacts of the state in which the run starts.
std::vector<std::string> stepWarnings(const Model& model, const ContactSet& touching);

}  // namespace softgauss::io
