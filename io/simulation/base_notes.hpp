// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How robots meet the world, and where it can hardly be meant so.

#include <optional>
#include <string>
#include <vector>

#include "softgauss/engine/dynamics/kinematics.hpp"
#include "softgauss/engine/step/contact_source.hpp"

namespace softgauss {

/// Where the base of a URDF came from.
enum class BaseOrigin {
  convention,  ///< floating, or fixed where the root is called world
  option,      ///< --base fixed or floating
  guess,       ///< --base auto
  scene        ///< a scene file says it of each robot
};

/// Whether a floating tree looks as if it were to be bolted down: nothing but shapes of its root is
/// within 5 mm of its lowest point, as of an arm or a hand and not of feet or wheels; or it has no
/// shapes to stand on.
bool looksBolted(const Model& model, const Kinematics& start, int tree);

struct BaseNotes {
  BaseOrigin origin = BaseOrigin::convention;
  std::vector<std::string> lines;     ///< one a robot, or one for many
  std::vector<std::string> warnings;  ///< where a base can hardly be meant to float
  std::vector<std::string> stances;   ///< where a robot can hardly be meant to stand so
  std::string straightKnees;          ///< on which robots stand, and what bends them; or nothing
};

/// `contacts` is asked what touches where the robots are lowered by 5 mm: their support. A robot is
/// a floating tree, of a scene one of more than one body, or the fixed one of a URDF. `otherStart`
/// says how a user starts elsewhere.
BaseNotes baseNotes(const Model& model, const State& start, ContactSource& contacts,
                    BaseOrigin origin, const std::string& otherStart);

/// What to try where a floating base fell that looks bolted down.
std::string boltAdvice(const std::string& base, BaseOrigin origin);

}  // namespace softgauss
