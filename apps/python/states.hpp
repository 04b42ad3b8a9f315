// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Many states of one scene, from which runs go on.

#include <atomic>
#include <vector>

#include "apps/python/arrays.hpp"
#include "apps/python/held.hpp"
#include "softgauss/io/simulation/time_grid.hpp"

namespace softgauss::python {

/// What Python calls throws std::runtime_error while a rollout has them.
class States {
 public:
  static constexpr const char* kName = "these states";

  /// The simulation's present state, n times.
  States(Held& held, long n);

  long size() const { return static_cast<long>(states_.size()); }
  /// Puts those rows, or all, where the scene starts, at q and v where they are given.
  void reset(const py::object& rows, const py::object& q, const py::object& v);
  RowMajorMatrixX q() const;
  RowMajorMatrixX v() const;
  VectorX time() const;
  std::size_t bytes() const;

  /// For a run that goes on from row `i`, and what it leaves there.
  void giveTo(SimulationParts& parts, long i) const;
  void takeFrom(const SimulationParts& parts, long i);
  const Model& model() const { return scene_.model; }
  std::atomic<bool>& busy() { return busy_; }

 private:
  std::vector<long> indicesOf(const py::object& rows) const;  ///< from indices or a mask
  std::vector<long> rowsOf(const py::object& rows) const;

  const Scene& scene_;
  std::vector<State> states_;
  std::vector<TimeGrid> grids_;
  std::atomic<bool> busy_ = false;
};

}  // namespace softgauss::python

SOFTGAUSS_MADE_ONLY(softgauss::python::States)
