// SPDX-License-Identifier: Apache-2.0
#pragma once

/// JSON schemas of the messages of an MCAP log.
///
/// Those of foxglove (docs.foxglove.dev/docs/sdk/schemas) have the fields that readers ask for; of
/// a scene's primitives, those that are written.

#include <string>
#include <vector>

namespace softgauss::io::detail {

std::string transformsSchema();   ///< foxglove.FrameTransforms
std::string sceneSchema();        ///< foxglove.SceneUpdate
std::string jointStatesSchema();  ///< foxglove.JointStates

/// A member that is a number or, with parts, an object of numbers.
struct NumberField {
  std::string name;
  std::vector<std::string> parts;
};

/// Objects of a timestamp and such members.
std::string numbersSchema(const std::string& title, const std::vector<NumberField>& fields);

}  // namespace softgauss::io::detail
