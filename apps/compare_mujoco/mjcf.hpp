// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A Model as MuJoCo's own description, so that both engines simulate the very same thing.
///
/// Bodies, joints and shapes are called b1, j1, g0 after their indices. A body without mass becomes
/// one more joint of the body that it carries, since MuJoCo wants mass in every body: with X_PB the
/// pose of the carried body, the joint's axis and anchor are seen from it. Positions and velocities
/// then have the same order and meaning in both engines. Connections and welds, which no URDF has,
/// are refused.

#include <string>

#include "softgauss/collision/filter.hpp"

namespace softgauss::app {

/// The XML text. Pairs of shapes that our filter leaves out are left out there too: by body where
/// that says the same, else every pair is listed. Throws ModelError where MuJoCo has no
/// counterpart.
std::string mjcfOf(const Model& model, const collision::PairFilter& filter);

}  // namespace softgauss::app
