// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/saved_state.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/bytes.hpp"
#include "softgauss/engine/core/sealed.hpp"
#include "softgauss/engine/model/model_hash.hpp"

namespace softgauss {
namespace {

constexpr std::string_view kStateKind = "SGSTATE\n";
constexpr std::uint32_t kStateVersion = 4;

/// Whether these are of the sizes that the model has, and of islands whose first tree sleeps too.
bool fits(const Model& model, const SleepState& sleep) {
  const SleepState own = State(model).sleep;
  if (sleep.island.size() != own.island.size() || sleep.restTime.size() != own.restTime.size() ||
      sleep.restSpeed.size() != own.restSpeed.size() ||
      sleep.restVelocity.size() != own.restVelocity.size() ||
      sleep.setPoint.size() != own.setPoint.size() ||
      sleep.setPointRate.size() != own.setPointRate.size())
    return false;
  const auto isTime = [](double x) { return x >= 0.0 && std::isfinite(x); };
  const int trees = static_cast<int>(sleep.island.size());
  return std::ranges::all_of(sleep.island,
                             [&](int first) {
                               return first == -1 || (first >= 0 && first < trees &&
                                                      sleep.island[idx(first)] == first);
                             }) &&
         std::ranges::all_of(sleep.restTime, isTime) &&
         std::ranges::all_of(sleep.restSpeed, isTime) && sleep.restVelocity.allFinite() &&
         sleep.setPoint.allFinite() && sleep.setPointRate.allFinite() &&
         !std::isnan(sleep.lastTime);
}

}  // namespace

void expectStateOf(const Model& model, const State& state) {
  const auto expect = [](bool holds, const char* problem) {
    if (!holds) ByteReader::fail(problem);
  };
  const WarmStart& warm = state.warmstart;
  const Eigen::Index forces = state.connectionForces.size();
  expect(state.q.size() == model.nq && state.v.size() == model.nv && state.a.size() == model.nv &&
             (forces == 0 || forces == 9 * static_cast<Eigen::Index>(model.connections.size())),
         "holds vectors that are not of the model's size");
  for (const VectorX* x : {&warm.a, &warm.gddA, &warm.multipliers, &warm.control})
    expect(x->size() == model.nv, "holds a warm start that is not of the model's size");
  expect(std::isfinite(state.time) && state.q.allFinite() && state.v.allFinite() &&
             state.a.allFinite() && state.connectionForces.allFinite(),
         "holds numbers that are not finite");
  constexpr double kRounding = 1e-6;  // each step normalises: runs keep far less
  for (const Body& body : model.bodies)
    expect(body.joint != JointKind::floating ||
               std::abs(state.q.segment<4>(body.q + 3).norm() - 1.0) < kRounding,
           "holds an orientation that is no rotation");
  expect(fits(model, state.sleep), "holds a sleep that no run has");
  constexpr int kMostSolves = 1 << 24;
  for (const auto& [counts, least] : {std::pair(&warm.gddSearchAge, 0), {&warm.gddSearchWait, 1}}) {
    expect(counts->size() == model.trees.size(), "holds counts that are not of the model's trees");
    for (const int count : *counts)
      expect(count >= least && count < kMostSolves, "holds counts of solves that no run has");
  }
}

std::string save(const Model& model, const State& state) {
  ByteWriter content;
  content(hash(model), state);
  return sealed(kStateKind, kStateVersion, content.bytes());
}

State restore(const Model& model, std::string_view bytes) {
  try {
    ByteReader content(unsealed(kStateKind, kStateVersion, bytes));
    std::uint64_t ofModel = 0;
    content(ofModel);
    if (ofModel != hash(model))
      ByteReader::fail("found a state of another model, or of other options, than '" + model.name +
                       "'");
    State state(model);
    content(state);
    content.expectEnd();
    expectStateOf(model, state);
    return state;
  } catch (const BytesError& error) {
    throw ModelError({}, "saved state", error.what());
  }
}

}  // namespace softgauss
