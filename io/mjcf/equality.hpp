// SPDX-License-Identifier: Apache-2.0
#pragma once

/// <equality>: connect, weld and joint.

#include "softgauss/io/mjcf/body.hpp"

namespace softgauss::io::mjcf {

/// Adds those that are active; counts the others. Points and poses that the file does not give are
/// where all joints at their references have them.
int readEqualities(const Element& element, const Defaults& defaults,
                   const std::vector<Body>& bodies, ModelBuilder& builder);

}  // namespace softgauss::io::mjcf
