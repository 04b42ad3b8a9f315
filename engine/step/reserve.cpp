// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/reserve.hpp"

#include <cmath>

#include "softgauss/engine/core/index.hpp"
#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/step.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"

namespace softgauss {
namespace {

Contact touching(const Model& model, const std::pair<int, int>& geometries) {
  constexpr double kTouches = -1e-6;  // [m]
  Contact contact;
  contact.geometryA = geometries.first;
  contact.geometryB = geometries.second;
  contact.bodyA = model.geometries[idx(geometries.first)].body;
  contact.bodyB = model.geometries[idx(geometries.second)].body;
  contact.distance = kTouches;
  return contact;
}

/// At rest, with every joint that has a range beyond it.
State beyondRanges(const Model& model) {
  constexpr double kBeyond = 1e-3;  // [rad or m]
  State state(model);
  for (const JointRange& range : model.ranges) {
    const double end = std::isfinite(range.upper) ? range.upper + kBeyond : range.lower - kBeyond;
    state.q[model.bodies[idx(range.body)].q] = end;
  }
  return state;
}

}  // namespace

void reserveRows(const Model& model, std::span<const std::pair<int, int>> geometries, int contacts,
                 Data& data) {
  const State state = beyondRanges(model);
  FixedContacts source;
  for (const auto& pair : geometries) {
    source.points.assign(idx(contacts), touching(model, pair));
    computeStages(model, {}, state, data, &source);
  }
  source.points.clear();
  for (const auto& pair : geometries) source.points.push_back(touching(model, pair));
  computeStages(model, {}, state, data, &source);
  forwardDynamics(model, nullptr, data);
  data.constraints.reserve(model);
  data.kinematics.V_midstep.reserve(model.bodies.size());
  if (!data.parts) return;
  for (State* kept : {&data.parts->before, &data.parts->start})
    kept->warmstart.breakpoints.reserve(idx(data.constraints.rowCount()));
  if (!data.parts->islands) return;
  reserveRows(model, geometries, contacts, data.parts->islands->data);
  data.parts->islands->reserve(data.contacts.contacts.capacity());
}

}  // namespace softgauss
