// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Checks of single elements of a description; each throws ModelError with what was expected.

#include <vector>

#include "softgauss/engine/model/model_builder.hpp"

namespace softgauss::detail {

void checkLink(const LinkSpec& link);
/// Beyond rounding. A body that it is part of may be sound all the same.
bool hasNegativeMoment(const LinkSpec& link);
void checkImpedance(const Impedance& impedance, const SourceLocation& where,
                    const std::string& element);
void checkJoint(const JointSpec& joint);
void checkMaterial(const Material& material, const Options& options, const SourceLocation& where,
                   const std::string& element);
void checkGeometry(const GeometrySpec& geometry, const Options& options);
void checkOptions(const Options& options);

/// What a body was merged from.
struct MergedBody {
  const LinkSpec* link = nullptr;  ///< the one that its joint carries; null for a part of a joint
  const LinkSpec* negative = nullptr;  ///< the first with a negative principal moment, if one has
};

/// After merging: a moving body with mass has a positive definite inertia, and every joint moves
/// some mass or has an armature. `merged` has every body.
void checkMovingInertias(const Model& model, const std::vector<MergedBody>& merged);

}  // namespace softgauss::detail
