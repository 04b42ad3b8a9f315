// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Pairs of geometries with a surface of their own, into a model whose geometries exist.

#include <vector>

#include "softgauss/engine/model/model_builder.hpp"

namespace softgauss::detail {

/// Throws ModelError with what was expected.
void addContactPairs(Model& model, const std::vector<PairSpec>& specs);

}  // namespace softgauss::detail
