// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Ranges of joints that follow others, against what their leaders ask for.

#include "softgauss/engine/model/model.hpp"

namespace softgauss::detail {

/// A joint that follows another may have a range of its own. Where the leader, within its range,
/// asks for more, or does so at the start, both cannot be had: the follower's range yields. It is
/// taken from the model, and a warning names the joints with both ranges. A leader that has no
/// range asks for nothing in particular: it goes as far as its followers let it. MuJoCo's model
/// keeps all ranges. Couplings, ranges and q0 are complete.
void relaxFollowerRanges(Model& model);

}  // namespace softgauss::detail
