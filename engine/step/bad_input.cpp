// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/bad_input.hpp"

#include <algorithm>
#include <cstdio>

#include "softgauss/engine/core/segment_vectors.hpp"

namespace softgauss {
namespace {

template <class Vector>
BadInput checkSize(BadInputKind kind, const Vector& x, int size) {
  const auto found = static_cast<int>(x.size());
  if (found == size) return {};
  return {kind, -1, static_cast<double>(found), static_cast<double>(size)};
}

std::string shortText(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

const char* nameOf(BadInputKind kind) {
  switch (kind) {
    case BadInputKind::none:
      break;
    case BadInputKind::q:
      return "State::q";
    case BadInputKind::v:
      return "State::v";
    case BadInputKind::a:
      return "the acceleration a";
    case BadInputKind::connectionForces:
      return "State::connectionForces";
    case BadInputKind::warmStart:
      return "the warm start";
    case BadInputKind::tau:
      return "Input::tau";
    case BadInputKind::sleep:
      return "State::sleep";
    case BadInputKind::setPoint:
      return "Input::setPoint or Input::setPointRate";
    case BadInputKind::controlled:
      return "Input::controlled";
    case BadInputKind::wrench:
      return "Input::wrenches";
    case BadInputKind::quaternion:
      return "State::q";
    case BadInputKind::controlLimitsSize:
    case BadInputKind::controlLimits:
      return "ControlLimits";
  }
  return "nothing";
}

}  // namespace

BadInput findBadInput(const Model& model, const Input& input) noexcept {
  if (input.tau.size() != 0)
    if (const BadInput bad = checkSize(BadInputKind::tau, input.tau, model.nv)) return bad;
  for (const VectorX* x : {&input.setPoint, &input.setPointRate})
    if (x->size() != 0)
      if (const BadInput bad = checkSize(BadInputKind::setPoint, *x, model.nv)) return bad;
  if (!input.controlled.empty()) {
    const auto trees = static_cast<int>(model.trees.size());
    if (const BadInput bad = checkSize(BadInputKind::controlled, input.controlled, trees))
      return bad;
  }
  int index = 0;
  for (const ExternalWrench& w : input.wrenches) {
    if (w.body < 0 || w.body >= model.bodyCount())
      return {BadInputKind::wrench, index, static_cast<double>(w.body),
              static_cast<double>(model.bodyCount())};
    ++index;
  }
  return {};
}

BadInput findBadInput(const Model& model, const Input& input, const State& state) noexcept {
  const Segment all{1, model.bodyCount()};
  return findBadInput(model, input, state, {&all, 1});
}

BadInput findBadInput(const Model& model, const Input& input, const State& state,
                      Segments bodies) noexcept {
  if (const BadInput bad = checkSize(BadInputKind::q, state.q, model.nq)) return bad;
  if (const BadInput bad = checkSize(BadInputKind::v, state.v, model.nv)) return bad;
  if (state.hasAcceleration)
    if (const BadInput bad = checkSize(BadInputKind::a, state.a, model.nv)) return bad;
  if (state.connectionForces.size() != 0) {
    const int numbers = 9 * static_cast<int>(model.connections.size());
    if (const BadInput bad =
            checkSize(BadInputKind::connectionForces, state.connectionForces, numbers))
      return bad;
  }
  if (const SleepState& sleep = state.sleep; !sleep.island.empty()) {
    const auto trees = static_cast<int>(model.trees.size());
    const BadInputKind kind = BadInputKind::sleep;
    if (const BadInput bad = checkSize(kind, sleep.island, trees)) return bad;
    for (const std::vector<double>* x : {&sleep.restTime, &sleep.restSpeed})
      if (const BadInput bad = checkSize(kind, *x, trees)) return bad;
    if (const BadInput bad = checkSize(kind, sleep.restVelocity, model.nv)) return bad;
  }
  const WarmStart& warm = state.warmstart;
  if (warm.valid)
    if (const BadInput bad = checkSize(BadInputKind::warmStart, warm.a, model.nv)) return bad;
  if (warm.gddValid)
    for (const VectorX* x : {&warm.gddA, &warm.multipliers})
      if (const BadInput bad = checkSize(BadInputKind::warmStart, *x, model.nv)) return bad;
  if (const BadInput bad = findBadInput(model, input)) return bad;
  return findBadQuaternion(model, state.q, bodies);
}

BadInput findBadQuaternion(const Model& model, const VectorX& q) noexcept {
  const Segment all{1, model.bodyCount()};
  return findBadQuaternion(model, q, {&all, 1});
}

BadInput findBadQuaternion(const Model& model, const VectorX& q, Segments bodies) noexcept {
  for (const Segment s : bodies)
    for (int b = s.begin; b < s.end; ++b) {
      const Body& body = model.bodies[static_cast<std::size_t>(b)];
      if (body.joint != JointKind::floating) continue;
      const auto quaternion = q.segment<4>(body.q + 3);
      const double length = quaternion.norm();
      if (quaternion.allFinite() &&
          !(length * kQuaternionFactor >= 1.0 && length <= kQuaternionFactor))
        return {BadInputKind::quaternion, b, length, 1.0};
    }
  return {};
}

bool isFinite(const Input& input, const State& state, const TreeSelection& trees) noexcept {
  if (!allFinite(trees.coordinates(), state.q)) return false;
  for (const VectorX* x : {&state.v, &input.tau, &input.setPoint, &input.setPointRate})
    if (x->size() > 0 && !allFinite(trees.dofs(), *x)) return false;
  return std::all_of(input.wrenches.begin(), input.wrenches.end(), [&](const ExternalWrench& w) {
    return w.F_Bo_W.force.allFinite() && w.F_Bo_W.moment.allFinite();
  });
}

int firstBadDof(const Model& model, const Input& input, const State& state) noexcept {
  for (const Body& body : model.bodies) {
    const int coordinates = body.dofs == 6 ? 7 : body.dofs;
    const auto bad = [&](const VectorX& x) {
      return x.size() == model.nv && !x.segment(body.v, body.dofs).allFinite();
    };
    if (!state.q.segment(body.q, coordinates).allFinite() || bad(state.v) || bad(input.tau) ||
        bad(input.setPoint) || bad(input.setPointRate))
      return body.v;
  }
  return -1;
}

std::string describe(const Model& model, const BadInput& bad) {
  const auto joint = [&](int body) {
    return " at joint '" + model.jointNames[static_cast<std::size_t>(body)] + "'";
  };
  const std::string name = nameOf(bad.kind);
  switch (bad.kind) {
    case BadInputKind::wrench:
      return name + "[" + std::to_string(bad.index) + "]: found body " + shortText(bad.found) +
             ", expected 0 to " + shortText(bad.expected - 1.0);
    case BadInputKind::quaternion:
      return name + ": found " +
             (bad.found == 0.0 ? "the quaternion (0, 0, 0, 0)"
                               : "a quaternion of length " + shortText(bad.found)) +
             joint(bad.index) + ", expected length 1";
    case BadInputKind::controlLimits:
      return name + ": found bounds of dof " + std::to_string(bad.index) +
             joint(model.dofs[static_cast<std::size_t>(bad.index)].body) +
             " that cross or are not numbers, expected lower ≤ upper";
    default:
      return name + ": found " + shortText(bad.found) + " numbers, expected " +
             shortText(bad.expected);
  }
}

}  // namespace softgauss
