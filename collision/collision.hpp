// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Contacts of a scene: softgauss::collision in one header.
///
///     SceneContacts contacts(model);                    // hulls, filter, bounding spheres
///     step(model, input, state, data, &contacts);
///     for (const ExcludedPair& pair : contacts.filter().excluded) puts(describe(pair).c_str());

#include "collision/convex_hull.hpp"
#include "collision/filter.hpp"
#include "collision/lowest_point.hpp"
#include "collision/primitive_pairs.hpp"
#include "collision/scene_contacts.hpp"
#include "collision/unit_contacts.hpp"
