// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contacts of a scene: softgauss::collision in one header.
///
///     SceneContacts contacts(model);                    // hulls, surfaces, filter
///     step(model, input, state, data, &contacts);
///     for (const ExcludedPair& pair : contacts.filter().excluded) puts(describe(pair).c_str());

#include "softgauss/collision/choose_meshes.hpp"
#include "softgauss/collision/clearance.hpp"
#include "softgauss/collision/convex_hull.hpp"
#include "softgauss/collision/fcl_contacts.hpp"
#include "softgauss/collision/filter.hpp"
#include "softgauss/collision/lowest_point.hpp"
#include "softgauss/collision/prepared_meshes.hpp"
#include "softgauss/collision/primitive_pairs.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/collision/triangle_mesh.hpp"
