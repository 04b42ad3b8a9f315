// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A simulation that is asked about another state than its own.

#include <optional>

#include "apps/python/arrays.hpp"
#include "softgauss/io/simulation/simulation.hpp"

namespace softgauss::python {

/// The simulation is at q (nq) and v (nv), where they are given, as long as this lives, without
/// what earlier steps have left.
class AtState {
 public:
  AtState(Simulation& sim, const py::object& q, const py::object& v) : state_(sim.state()) {
    if (q.is_none() && v.is_none()) return;
    State at = state_;
    if (!q.is_none()) at.q = vectorOf(q, "q", sim.model().nq, "nq");
    if (!v.is_none()) at.v = vectorOf(v, "v", sim.model().nv, "nv");
    at.hasAcceleration = false;
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

}  // namespace softgauss::python
