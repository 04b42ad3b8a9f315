// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How a robot that floats stands at the start, and where it can hardly be meant so.

#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/constraints/contact_set.hpp"
#include "softgauss/engine/dynamics/kinematics.hpp"

namespace softgauss {

/// A robot that stands on its shins, say, with its feet in the air: a link in contact with the
/// world, not the root, carries a limb whose end touches nothing; or the root is in contact and
/// such an end is called foot, sole, toe or wheel. `touching` are contacts with what is within
/// reach of the ground.
std::optional<std::string> standingWarning(const Model& model, const Kinematics& start, int tree,
                                           const ContactSet& touching);

/// The knees, by name, that are straight of the legs on which the robot stands: from there a leg
/// cannot lower the base but by a kick. A knee is the hinge of a leg with the longest levers to
/// both of its ends; it is straight where these are within 6° of one line.
std::vector<std::string> straightKnees(const Model& model, const Kinematics& start, int tree,
                                       const ContactSet& touching);

}  // namespace softgauss
