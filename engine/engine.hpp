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

#include "engine/dynamics/energy.hpp"    // energy, momentum, centre of mass
#include "engine/dynamics/jacobian.hpp"  // point and rotation Jacobians
#include "engine/islands/islands.hpp"    // a scene in parts that sleep
#include "engine/model/model_builder.hpp"
#include "engine/model/state.hpp"
#include "engine/step/effect_use.hpp"  // what each effect costs
#include "engine/step/forward.hpp"     // (13)
#include "engine/step/inverse.hpp"     // (14), (15)
#include "engine/step/snapshot.hpp"
#include "engine/step/step.hpp"
