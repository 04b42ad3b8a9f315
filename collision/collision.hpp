// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contacts of a scene: softgauss::collision in one header.
///
///     SceneContacts contacts(model);                    // hulls, surfaces, filter
///     step(model, input, state, data, &contacts);
///     for (const ExcludedPair& pair : contacts.filter().excluded) puts(describe(pair).c_str());

#include "collision/choose_meshes.hpp"
#include "collision/clearance.hpp"
#include "collision/convex_hull.hpp"
#include "collision/fcl_contacts.hpp"
#include "collision/filter.hpp"
#include "collision/lowest_point.hpp"
#include "collision/prepared_meshes.hpp"
#include "collision/primitive_pairs.hpp"
#include "collision/scene_contacts.hpp"
#include "collision/triangle_mesh.hpp"
#include "collision/unit_contacts.hpp"
