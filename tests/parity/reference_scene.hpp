// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The scene of a reference log as a model of this engine.
///
/// A log holds its scene once, and both engines read that (tests/mujoco_reference/scene.mjs tells
/// the form), so the two models cannot differ by a typing error. What the scene leaves out has the
/// engine's default. Words that this reader does not know are an error, for a scene that is read in
/// part would compare two different systems.

#include <nlohmann/json.hpp>

#include "softgauss/engine/model/model.hpp"

namespace softgauss::test {

/// `scene` and `options` as in a log. Throws std::runtime_error or ModelError.
Model referenceModel(const std::string& name, const nlohmann::json& scene,
                     const nlohmann::json& options);

}  // namespace softgauss::test
