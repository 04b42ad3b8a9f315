// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A simulation that is asked about another state than its own.

#include <optional>
#include <string>

#include "apps/python/arrays.hpp"
#include "softgauss/io/names.hpp"
#include "softgauss/io/simulation/simulation.hpp"

namespace softgauss::python {

/// Throws StepError where these are no configuration: NaN, ∞, or a quaternion of length 0, as the
/// step refuses them.
inline void expectConfiguration(const Model& model, const VectorX& q) {
  for (int b = 1; b < model.bodyCount(); ++b) {
    const Body& body = model.bodies[static_cast<std::size_t>(b)];
    const bool floats = body.joint == JointKind::floating;
    const int numbers = floats ? 7 : body.dofs;
    if (!q.segment(body.q, numbers).allFinite())
      throw StepError("q: found NaN or ∞ at joint '" +
                      model.jointNames[static_cast<std::size_t>(b)] +
                      "', expected a configuration");
  }
  if (const BadInput bad = findBadQuaternion(model, q)) throw StepError(describe(model, bad));
}

/// The simulation is at q (nq) and v (nv), where they are given, as long as this lives, without
/// what earlier steps have left. Throws StepError where it is no configuration.
class AtState {
 public:
  AtState(Simulation& sim, const py::object& q, const py::object& v) : state_(sim.state()) {
    if (q.is_none() && v.is_none()) {
      expectConfiguration(sim.model(), state_.q);
      return;
    }
    State at = state_;
    if (!q.is_none()) at.q = vectorOf(q, "q", sim.model().nq, "nq");
    if (!v.is_none()) at.v = vectorOf(v, "v", sim.model().nv, "nv");
    expectConfiguration(sim.model(), at.q);
    at.forgetLastStep();
    at.warmstart = {};
    own_ = state_;
    state_ = at;
  }
  ~AtState() {
    if (own_) state_ = *own_;
  }
  AtState(const AtState&) = delete;
  AtState& operator=(const AtState&) = delete;

 private:
  State& state_;
  std::optional<State> own_;
};

/// A simulation at some q and v, with poses there.
struct Posed : AtState {
  Posed(Simulation& sim, const py::object& q, const py::object& v)
      : AtState(sim, q, v), model(sim.model()), state(sim.state()), k(model) {
    computeKinematics(model, state, k);
  }
  /// Where a point (3,) of a link's frame is in the world [m].
  Vector3 placeOf(const Frame& frame, const py::object& point) const {
    return k.X_WB[idx(frame.body)] * (frame.X_BF * vector3Of(point, "point"));
  }

  const Model& model;
  const State& state;
  Kinematics k;
};

/// The frame of a link. Throws NameError, which begins with who asks.
inline const Frame& frameOf(const Model& model, const std::string& link, const std::string& who) {
  const int index = model.findFrame(link);
  if (index < 0) throw NameError(who + ": " + io::linkProblem(model, link));
  return model.frames[idx(index)];
}

}  // namespace softgauss::python
