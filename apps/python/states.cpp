// SPDX-License-Identifier: Apache-2.0
#include "apps/python/states.hpp"

#include "softgauss/engine/core/memory.hpp"
#include "softgauss/io/simulation/simulation_parts.hpp"

namespace softgauss::python {

States::States(Held& held, long n) : scene_(held.sim().scene()) {
  if (n < 1) throw py::value_error("states: found " + std::to_string(n) + ", expected 1 or more");
  const SimulationParts& parts = held.sim().parts();
  states_.assign(static_cast<std::size_t>(n), parts.state);
  grids_.assign(static_cast<std::size_t>(n), parts.grid);
}

std::vector<long> States::indicesOf(const py::object& rows) const {
  const auto refuse = [&] {
    throw py::type_error("rows: found " + py::repr(rows).cast<std::string>() +
                         ", expected indices or a mask of True and False, (n,) = (" +
                         std::to_string(size()) + ",)");
  };
  const py::array given = py::array::ensure(rows);
  if (!given) PyErr_Clear();
  if (!given || given.ndim() != 1) refuse();
  const char kind = given.dtype().kind();
  std::vector<long> chosen;
  if (kind == 'b') {
    if (given.size() != size()) refuse();
    const auto mask = py::array_t<bool>(given);
    for (long i = 0; i < size(); ++i)
      if (mask.at(i)) chosen.push_back(i);
  } else if (kind == 'i' || kind == 'u') {
    chosen = given.cast<std::vector<long>>();
  } else if (given.size() > 0) {
    refuse();
  }
  return chosen;
}

std::vector<long> States::rowsOf(const py::object& rows) const {
  std::vector<long> chosen;
  if (rows.is_none())
    for (long i = 0; i < size(); ++i) chosen.push_back(i);
  else
    chosen = indicesOf(rows);
  for (const long i : chosen)
    if (i < 0 || i >= size())
      throw py::index_error("states: found row " + std::to_string(i) + ", there are " +
                            std::to_string(size()));
  return chosen;
}

void States::reset(const py::object& rows, const py::object& q, const py::object& v) {
  const Turn turn(busy_, kName);
  const std::vector<long> chosen = rowsOf(rows);
  const auto n = static_cast<py::ssize_t>(chosen.size());
  Numbers newQ, newV;
  if (!q.is_none()) newQ = numbersOf(q, "q", {n, model().nq}, "(rows, nq)");
  if (!v.is_none()) newV = numbersOf(v, "v", {n, model().nv}, "(rows, nv)");
  for (py::ssize_t k = 0; k < n; ++k) {
    const auto i = static_cast<std::size_t>(chosen[static_cast<std::size_t>(k)]);
    states_[i] = scene_.initial;
    grids_[i] = {};
    if (!q.is_none()) states_[i].q = Eigen::Map<const VectorX>(newQ.data(k), model().nq);
    if (!v.is_none()) states_[i].v = Eigen::Map<const VectorX>(newV.data(k), model().nv);
  }
}

RowMajorMatrixX States::q() const {
  expectIdle(busy_, kName);
  RowMajorMatrixX all(size(), model().nq);
  for (long i = 0; i < size(); ++i) all.row(i) = states_[static_cast<std::size_t>(i)].q;
  return all;
}

RowMajorMatrixX States::v() const {
  expectIdle(busy_, kName);
  RowMajorMatrixX all(size(), model().nv);
  for (long i = 0; i < size(); ++i) all.row(i) = states_[static_cast<std::size_t>(i)].v;
  return all;
}

VectorX States::time() const {
  expectIdle(busy_, kName);
  VectorX all(size());
  for (long i = 0; i < size(); ++i) all[i] = states_[static_cast<std::size_t>(i)].time;
  return all;
}

std::size_t States::bytes() const {
  expectIdle(busy_, kName);
  std::size_t sum = bytesOf(states_) + bytesOf(grids_);
  for (const State& s : states_) {
    const WarmStart& w = s.warmstart;
    sum += bytesOfAll(s.q, s.v, s.a, w.a, w.gddA, w.multipliers, w.control, s.sleep.island,
                      s.sleep.restTime, s.sleep.restSpeed, s.sleep.restVelocity) +
           bytesOf(w.breakpoints);
  }
  return sum;
}

void States::giveTo(SimulationParts& parts, long i) const {
  parts.state = states_[static_cast<std::size_t>(i)];
  if (parts.data->sleepers) parts.data->sleepers->forgetSeen();  // whoever ran here before
  parts.grid = grids_[static_cast<std::size_t>(i)];
}

void States::takeFrom(const SimulationParts& parts, long i) {
  states_[static_cast<std::size_t>(i)] = parts.state;
  grids_[static_cast<std::size_t>(i)] = parts.grid;
}

}  // namespace softgauss::python
