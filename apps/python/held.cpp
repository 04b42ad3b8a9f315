// SPDX-License-Identifier: Apache-2.0
#include "apps/python/held.hpp"

#include <cmath>

#include "softgauss/io/simulation/time_grid.hpp"

namespace softgauss::python {

namespace {

[[noreturn]] void refuseSecond(const char* what) {
  throw std::runtime_error(std::string("another thread uses ") + what + ", expected one at a time");
}

}  // namespace

void expectIdle(const std::atomic<bool>& busy, const char* what) {
  if (busy.load(std::memory_order_acquire)) refuseSecond(what);
}

Turn::Turn(std::atomic<bool>& busy, const char* what) : busy_(busy) {
  if (busy_.exchange(true, std::memory_order_acquire)) refuseSecond(what);
}

void seeSignals() {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

Simulation& Held::sim() {
  expectIdle(busy_, "this simulation");
  return sim_;
}

void Held::clearGoals() {
  SimulationGoals& goals = sim().goals;
  ++goalsLeft_;
  for (std::size_t i = 0; i < goals.size(); ++i) left_[&goals[i]] = goalsLeft_;
  goals.clear();
}

void Held::removeGoal(const gdd::Goal& goal) {
  sim().goals.remove(goal);
  left_[&goal] = ++goalsLeft_;
}

void Held::step(long n) {
  if (n < 0)
    throw py::value_error("step: found " + std::to_string(n) + " steps, expected 0 or more");
  constexpr long kLook = 64;  // steps between two looks for Ctrl-C
  const Turn turn(busy_, "this simulation");
  const py::gil_scoped_release release;
  for (long i = 1; i <= n; ++i) {
    if (!pushes_.empty()) pushes_.act(sim_);
    if (isRefused(sim_.step())) throw StepError(sim_.failure());
    if (i % kLook == 0) seeSignals();
  }
}

void Held::run(double seconds) {
  if (!(seconds >= 0.0 && std::isfinite(seconds)))
    throw py::value_error("run: found " + std::to_string(seconds) +
                          " s, expected a time of 0 or more");
  step(stepsIn(seconds, sim().model().options.timestep));
}

}  // namespace softgauss::python
