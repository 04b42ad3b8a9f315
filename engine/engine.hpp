// SPDX-License-Identifier: Apache-2.0
#pragma once

/// softgauss::engine on one screen.
///
///   ModelBuilder builder;            // or io::loadUrdf
///   const Model model = builder.link(…).joint(…).build();
///   State state(model);              // q, v, time, warm start
///   Data data(model);                // all memory of a thread
///   step(model, Input{}, state, data, nullptr);
///
/// Model is immutable and shared between threads; a thread brings its own State and Data.

#include "softgauss/engine/dynamics/energy.hpp"    // energy, momentum, centre of mass
#include "softgauss/engine/dynamics/jacobian.hpp"  // point and rotation Jacobians
#include "softgauss/engine/model/model_builder.hpp"
#include "softgauss/engine/model/state.hpp"
#include "softgauss/engine/step/effect_use.hpp"  // what each effect costs
#include "softgauss/engine/step/forward.hpp"     // (13)
#include "softgauss/engine/step/inverse.hpp"     // (14), (15)
#include "softgauss/engine/step/sleep.hpp"       // what rests costs nothing
#include "softgauss/engine/step/snapshot.hpp"
#include "softgauss/engine/step/step.hpp"
