// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Connections, welds and joint couplings of a description, into a model whose bodies and frames
/// exist.

#include <vector>

#include "softgauss/engine/model/model_builder.hpp"

namespace softgauss::detail {

/// Each throws ModelError with what was expected.
void addConnections(Model& model, const std::vector<ConnectSpec>& specs);
void addWelds(Model& model, const std::vector<WeldSpec>& specs);
/// The mimics of joints, then the couplings.
void addCouplings(Model& model, const std::vector<JointSpec>& joints,
                  const std::vector<CouplingSpec>& specs);

}  // namespace softgauss::detail
