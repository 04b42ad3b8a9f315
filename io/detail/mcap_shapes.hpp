// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The shapes of a model as a message of foxglove.SceneUpdate.

#include "softgauss/engine/model/model.hpp"
#include "softgauss/io/detail/json_text.hpp"

namespace softgauss::io::detail {

/// An entity for every link that is drawn, in the link's frame: its visuals or, where it has none,
/// its collision shapes. Planes, and meshes without triangles, are left out.
void writeShapes(const Model& model, double time, JsonText& json);

/// What every entity begins with, up to its primitives.
void beginEntity(const std::string& id, const std::string& frame, double time, JsonText& json);

void writeColor(const Eigen::Vector4d& rgba, JsonText& json);

}  // namespace softgauss::io::detail
