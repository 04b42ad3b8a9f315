// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A state as bytes, which go on to the same bits: what checkpoints, and whoever branches a run,
/// keep of it.
///
///   const std::string bytes = save(model, state);
///   State again = restore(model, bytes);   // in another process, on the same kind of machine
///
/// A State in memory is the same thing: everything that the next step depends on.

#include <cstdint>
#include <string>
#include <string_view>

#include "softgauss/engine/model/state.hpp"

namespace softgauss {

/// The bytes hold a version, the model's hash and a checksum.
std::string save(const Model& model, const State& state);

/// Throws ModelError where the bytes are no saved state, of another version, were changed, or are
/// of another model: one with another hash(const Model&), options included.
State restore(const Model& model, std::string_view bytes);

// The parts, for who keeps more than a state (core/bytes.hpp). Structured bindings name every
// field: one that is added does not compile before it is saved.
template <class Archive>
void archive(Archive& a, RowKey& name) {
  auto& [first, second, contact, direction] = name;
  a(first, second, contact, direction);
}
template <class Archive>
void archive(Archive& a, BreakpointKey& name) {
  auto& [kind, row, index] = name;
  a(kind, row, index);
}
template <class Archive>
void archive(Archive& a, WarmStart& warmstart) {
  auto& [acceleration, gddA, multipliers, control, breakpoints, gddSearchAge, gddSearchWait, valid,
         gddValid] = warmstart;
  a(acceleration, gddA, multipliers, control, breakpoints, gddSearchAge, gddSearchWait, valid,
    gddValid);
}
template <class Archive>
void archive(Archive& a, SleepState& sleep) {
  auto& [island, restTime, restSpeed, restVelocity, setPoint, setPointRate, lastTime] = sleep;
  a(island, restTime, restSpeed, restVelocity, setPoint, setPointRate, lastTime);
}
template <class Archive>
void archive(Archive& a, State& state) {
  auto& [q, v, time, acceleration, hasAcceleration, connectionForces, warmstart, sleep] = state;
  a(q, v, time, acceleration, hasAcceleration, connectionForces, warmstart, sleep);
}

/// Throws BytesError where a state that was read is none of the model's.
void expectStateOf(const Model& model, const State& state);

}  // namespace softgauss
