// SPDX-License-Identifier: Apache-2.0
/// Simulation: the controller without a step, and contacts.

#include "apps/python/at_state.hpp"
#include "apps/python/held.hpp"

namespace softgauss::python {
namespace {

struct Contacts {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  std::vector<std::pair<std::string, std::string>> links;
  Rows point, normal, force;
};

Contacts contactsOf(const Model& model, const std::vector<Snapshot::ContactForce>& touching) {
  Contacts contacts;
  const auto n = static_cast<Eigen::Index>(touching.size());
  contacts.point = contacts.normal = contacts.force = Contacts::Rows(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Snapshot::ContactForce& c = touching[static_cast<std::size_t>(i)];
    const auto& shapes = model.geometries;
    contacts.links.emplace_back(shapes[static_cast<std::size_t>(c.geometryA)].link,
                                shapes[static_cast<std::size_t>(c.geometryB)].link);
    contacts.point.row(i) = c.p_WC;
    contacts.normal.row(i) = c.n_W;
    contacts.force.row(i) = c.force;
  }
  return contacts;
}

const char* nameOf(gdd::GddStatus status) {
  switch (status) {
    case gdd::GddStatus::converged:
      return "converged";
    case gdd::GddStatus::nonsmoothMinimum:
      return "kink";
    case gdd::GddStatus::iterationLimit:
      return "iteration limit";
    case gdd::GddStatus::nonsmoothStall:
      return "bend";
    case gdd::GddStatus::undecided:
      return "undecided";
    case gdd::GddStatus::badLimits:
      return "bad box";
    case gdd::GddStatus::notFinite:
      break;
  }
  return "not finite";
}

struct Solution {
  VectorX tau, a;
  Contacts contacts;
  gdd::GddReport report;
  bool isCertified() const {
    return report.status == gdd::GddStatus::converged ||
           report.status == gdd::GddStatus::nonsmoothMinimum;
  }
};

}  // namespace
}  // namespace softgauss::python

SOFTGAUSS_MADE_ONLY(softgauss::python::Contacts)
SOFTGAUSS_MADE_ONLY(softgauss::python::Solution)

namespace softgauss::python {
namespace {

Solution solve(Held& held, const py::object& q, const py::object& v) {
  return held.alone([&](Simulation& sim) {
    const AtState at(sim, q, v);
    const py::gil_scoped_release release;
    ControlSolution found = sim.solve();
    if (isRefused(found.status)) throw StepError(sim.failure());
    return Solution{std::move(found.tau), std::move(found.a),
                    contactsOf(sim.model(), found.contacts), found.report};
  });
}

void bindContacts(py::module_& m) {
  py::class_<Contacts>(m, "Contacts", "Contacts, one a row, world axes.")
      .def_readonly("links", &Contacts::links, "The two links that touch; '' for the world's own.")
      .def_readonly("point", &Contacts::point, "(n, 3) where the force acts [m]")
      .def_readonly("normal", &Contacts::normal, "(n, 3) unit, from the first link to the second")
      .def_readonly("force", &Contacts::force, "(n, 3) on the second link; the first feels −f [N]")
      .def("__len__", [](const Contacts& c) { return c.links.size(); });
}

void bindSolution(py::module_& m) {
  py::class_<Solution>(m, "Solution", "What the controller answers to a state.")
      .def_readonly("tau", &Solution::tau, "(nv,) control [N m or N]")
      .def_readonly("a", &Solution::a, "(nv,) acceleration that it causes [rad/s² or m/s²]")
      .def_readonly("contacts", &Solution::contacts, "Contacts, with the forces that go with it.")
      .def_property_readonly("certified", &Solution::isCertified,
                             "Whether it is known to be a minimum of the goals' cost.")
      .def_property_readonly(
          "status", [](const Solution& s) { return nameOf(s.report.status); },
          "converged, kink, iteration limit, bend, undecided.")
      .def_property_readonly(
          "stationarity", [](const Solution& s) { return s.report.stationarity; },
          "The certificate: 0 at a minimum, without unit.")
      .def_property_readonly(
          "violation", [](const Solution& s) { return s.report.violation; },
          "How far the control lies outside its bounds [N m or N].")
      .def_property_readonly(
          "objective", [](const Solution& s) { return s.report.objective; },
          "Cost of the goals and of force, up to a constant.")
      .def_property_readonly(
          "iterations", [](const Solution& s) { return s.report.iterations; }, "Of the solver.");
}

}  // namespace

void bindControl(py::module_& m, HeldClass& sim) {
  bindContacts(m);
  bindSolution(m);
  sim.def("solve", solve, py::arg("q") = py::none(), py::arg("v") = py::none(),
          "The controller without a step: control, acceleration and contact forces at q (nq,) and\n"
          "v (nv,), or at the present ones. The state is left as it is. Where q or v is given the\n"
          "answer depends on them and on the goals alone. Without goals the control is `tau`.\n"
          "Raises StepError.");
  sim.def_property_readonly(
      "contacts",
      [](Held& h) {
        std::vector<Snapshot::ContactForce> touching;
        contactForces(h.sim().data(), touching);
        return contactsOf(h.sim().model(), touching);
      },
      "Contacts of the last step, with their forces.");
}

}  // namespace softgauss::python
