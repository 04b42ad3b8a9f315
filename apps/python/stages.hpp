// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The stages of a step from the present state of a simulation, which all that is asked of its
/// dynamics reads.

#include "apps/python/arrays.hpp"
#include "softgauss/engine/engine.hpp"
#include "softgauss/io/simulation/simulation_parts.hpp"

namespace softgauss::python {

/// Throws StepError where it is refused.
inline void expectSolved(Simulation& sim, SolveStatus status) {
  if (isRefused(status)) throw StepError(sim.failure());
}

/// A force (nv) [N, N m]: that of the simulation where it is None.
inline VectorX forceOf(Simulation& sim, const py::object& tau) {
  return tau.is_none() ? sim.input().tau : vectorOf(tau, "tau", sim.model().nv, "nv");
}

/// An acceleration (nv). Throws ValueError where it is not finite.
inline VectorX accelerationOf(Simulation& sim, const py::object& a) {
  VectorX wished = vectorOf(a, "a", sim.model().nv, "nv");
  if (!wished.allFinite()) throw py::value_error("a: found NaN or ∞, expected finite numbers");
  return wished;
}

/// What acts in a step under a force.
inline Input inputUnder(Simulation& sim, const VectorX& tau) {
  Input input = sim.parts().inputOfStep();
  input.tau = tau;
  return input;
}

/// The stages under it, with M and J where `matrices`; what acts. Throws StepError.
inline Input computeStagesUnder(Simulation& sim, const VectorX& tau, bool matrices) {
  Input input = inputUnder(sim, tau);
  const auto compute = matrices ? computeStages : computeBodyStages;
  expectSolved(sim, compute(sim.model(), input, sim.state(), sim.data(), &sim.contacts()));
  return input;
}

}  // namespace softgauss::python
