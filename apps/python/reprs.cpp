// SPDX-License-Identifier: Apache-2.0
/// What an interactive session prints of objects: what they are of, and how far.

#include <fmt/format.h>

#include <algorithm>

#include "apps/python/goals.hpp"
#include "apps/python/held.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::python {
namespace {

using io::detail::counted;

std::string simulationRepr(Held& held) {
  const Simulation& sim = held.sim();
  const Model& model = sim.model();
  return fmt::format("<softgauss.Simulation of '{}': {}, {}, at {:g} s>", model.name,
                     counted(static_cast<std::size_t>(model.nv), "degree") + " of freedom",
                     counted(sim.goals.size(), "goal"), sim.state().time);
}

std::string goalsRepr(GoalList& list) {
  std::string names;
  for (std::size_t i = 0; i < list.held.sim().goals.size(); ++i)
    names += (i > 0 ? ", " : "") + list.held.sim().goals[i].name();
  return "<softgauss.Goals: " + (names.empty() ? "none" : names) + ">";
}

}  // namespace

void bindReprs(py::module_& m, HeldClass& sim) {
  sim.def("__repr__", simulationRepr);
  const auto of = [&](const char* name, auto repr) {
    m.attr(name).attr("__repr__") = py::cpp_function(repr, py::is_method(m.attr(name)));
  };
  of("Goals", goalsRepr);
  // Of the others by what Python sees of them.
  of("Contacts", [](const py::object& c) {
    return "<softgauss.Contacts: " + counted(py::len(c), "point") + ">";
  });
  of("Solution", [](const py::object& s) {
    return fmt::format("<softgauss.Solution: {}, {}, {}>", s.attr("status").cast<std::string>(),
                       s.attr("certified").cast<bool>() ? "certified" : "not certified",
                       counted(py::len(s.attr("contacts")), "contact"));
  });
  of("Plan", [](const py::object& p) {
    return fmt::format("<softgauss.Plan: {} of {:g} s, cost {:g}, {}>",
                       counted(py::len(p.attr("u")), "step"), p.attr("step").cast<double>(),
                       p.attr("cost").cast<double>(), p.attr("status").cast<std::string>());
  });
  of("Runs", [](const py::object& r) {
    const auto status = r.attr("status").cast<std::vector<std::string>>();
    const auto failed =
        static_cast<std::size_t>(std::count(status.begin(), status.end(), std::string("failed")));
    return fmt::format("<softgauss.Runs: {}, {} failed>", status.size(), failed);
  });
  of("Rollout", [](const py::object& r) {
    return fmt::format("<softgauss.Rollout on {}>",
                       counted(r.attr("threads").cast<std::size_t>(), "thread"));
  });
  of("States",
     [](const py::object& s) { return "<softgauss.States: " + std::to_string(py::len(s)) + ">"; });
}

}  // namespace softgauss::python
