// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "apps/rivals/judge/measures.hpp"

namespace rivals {

/// What bounces, screws and walks; see measure(). Needs a run of more than two samples.
Measures measureBounce(const Scene& scene, const Trajectory& run);
Measures measureNut(const Scene& scene, const Trajectory& run);
Measures measureFeet(const Scene& scene, const Trajectory& run);

/// How far a nut, the second body, sinks from rest on the thread of the first in that time [m]: 0
/// where friction locks it.
double sinkOfNut(const Scene& scene, double time);

/// How far the frames of a walker go, of which the standing one does not slip [m].
double wayOfFeet(const Scene& scene);

}  // namespace rivals
