// SPDX-License-Identifier: Apache-2.0
#include "tests/random_scenes/step_laws.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/bytes.hpp"
#include "softgauss/engine/model/saved_state.hpp"
#include "tests/random_scenes/finding.hpp"

namespace softgauss::fuzz {
namespace {

bool isFinite(const Input& input) {
  return input.tau.allFinite() &&
         std::all_of(input.wrenches.begin(), input.wrenches.end(), [](const ExternalWrench& w) {
           return w.F_Bo_W.moment.allFinite() && w.F_Bo_W.force.allFinite();
         });
}

bool isFinite(const State& state) { return state.q.allFinite() && state.v.allFinite(); }

}  // namespace

std::string bytesOf(const State& state) {
  ByteWriter writer;
  writer(state);
  return writer.bytes();
}

Run::Run(const Model& model, const State& start, ContactSource* contacts)
    : model_(model), state_(start), contacts_(contacts), data_(model) {}

SolveStatus Run::steps(const Input& input, int count) {
  SolveStatus status = SolveStatus::converged;
  for (int i = 0; i < count; ++i) {
    const State before = state_;
    status = step(model_, input, state_, data_, contacts_);
    if (isRefused(status)) {
      if (bytesOf(state_) != bytesOf(before)) throw Finding("a refused step has changed the state");
      return status;
    }
    if (!isFinite(before) || !isFinite(input)) throw Finding("what is not finite was not refused");
    expectTaken(before);
  }
  return status;
}

void Run::expectTaken(const State& before) const {
  if (!isFinite(state_)) throw Finding("a step was taken to a state that is not finite");
  if (!(state_.time >= before.time)) throw Finding("time does not go on");
  for (const Body& body : model_.bodies) {
    if (body.joint != JointKind::floating) continue;
    // Each step normalises: a rounding or two are left.
    constexpr double kRounding = 1e-12;
    if (std::abs(state_.q.segment<4>(body.q + 3).norm() - 1.0) > kRounding)
      throw Finding("an orientation that is no rotation");
  }
}

}  // namespace softgauss::fuzz
