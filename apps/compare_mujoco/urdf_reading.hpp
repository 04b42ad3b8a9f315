// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Does MuJoCo read the same robot in the URDF as we do?
///
/// The comparison runs on our model, written in MuJoCo's own terms (mjcf.hpp). Here MuJoCo reads
/// the URDF by itself, from a copy (urdf_copy.hpp), and its model is held against ours: bodies and
/// joints by their names, shapes by what and where they are, M and smooth accelerations in random
/// states.

#include <nlohmann/json.hpp>

#include "apps/compare_mujoco/urdf_copy.hpp"

namespace softgauss::app {

/// The largest differences. Relative ones: `total_mass`, `body_mass`, `inertia` (to the body's
/// largest entry), `mass_matrix` (to √(M_ii M_jj)), `smooth_acceleration` (to the largest of the
/// state), `inverse_weight`, `damping`, `dry_friction`; others in m, rad or 1. `shapes` are those
/// of ours that MuJoCo has too, `shapes_ours` how many there are. `differs` lists what is not the
/// same in kind, `not_read` what MuJoCo reads otherwise or not at all. Where MuJoCo refuses the
/// file, `refused` holds its words and nothing else is there.
nlohmann::ordered_json compareReading(const Model& model, const UrdfCopy& copy);

}  // namespace softgauss::app
