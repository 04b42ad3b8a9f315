// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Checks of single elements of a description; each throws ModelError with what was expected.

#include <vector>

#include "engine/model/model_builder.hpp"

namespace softgauss::detail {

void checkLink(const LinkSpec& link);
void checkImpedance(const Impedance& impedance, const SourceLocation& where,
                    const std::string& element);
void checkJoint(const JointSpec& joint);
void checkMaterial(const Material& material, const Options& options, const SourceLocation& where,
                   const std::string& element);
void checkGeometry(const GeometrySpec& geometry, const Options& options);
void checkOptions(const Options& options);

/// After merging: a moving body with mass has a positive definite inertia, and every joint moves
/// some mass. `where[i]` is the place of body i's link, or null.
void checkMovingInertias(const Model& model, const std::vector<const SourceLocation*>& where);

}  // namespace softgauss::detail
