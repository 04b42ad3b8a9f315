// SPDX-License-Identifier: Apache-2.0
#include "apps/python/module.hpp"

#include "apps/python/held.hpp"
#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/simulation/simulation.hpp"

namespace softgauss::python {

void bindErrors(py::module_& m) {
  py::register_exception<ModelError>(m, "ModelError", PyExc_ValueError).doc() =
      "A model, scene or goal that cannot be simulated: file, line, element, what was expected.";
  py::register_exception<OptionError>(m, "OptionError", PyExc_ValueError).doc() =
      "An option that does not fit what is loaded.";
  py::register_exception<NameError>(m, "UnknownName", PyExc_LookupError).doc() =
      "A link, joint or parameter that the model lacks, with the nearest that it has.";
  py::register_exception<StepError>(m, "StepError", PyExc_ArithmeticError).doc() =
      "A step that was refused: the time, the joint, the deepest contact.";
}

namespace {

/// Env and VectorEnv are written in Python, beside this module, and are loaded when they are asked
/// for: the rest needs nothing but numpy.
void bindEnvironments(py::module_& m) {
  m.def("__getattr__", [](const std::string& name) -> py::object {
    if (name != "Env" && name != "VectorEnv" && name != "Box")
      throw py::attribute_error("module 'softgauss' has no attribute '" + name + "'");
    return py::module_::import("softgauss_env").attr(name.c_str());
  });
  m.def("__dir__", [m] {
    py::list names;
    for (const auto& name : m.attr("__dict__").attr("keys")()) names.append(name);
    for (const char* name : {"Box", "Env", "VectorEnv"}) names.append(name);
    return names;
  });
}

}  // namespace
}  // namespace softgauss::python

PYBIND11_MODULE(softgauss, m) {
  namespace py = pybind11;
  m.doc() =
      "Soft-constraint rigid-body physics with goal directed dynamics.\n\n"
      "SI units and radians; world axes with z up; quaternions are w first. The velocity of a\n"
      "floating base is the world velocity of its origin, then its angular velocity in its own\n"
      "axes.";
  m.attr("__version__") = SOFTGAUSS_VERSION;
  softgauss::python::bindErrors(m);
  softgauss::python::bindGoals(m);
  softgauss::python::HeldClass sim(
      m, "Simulation",
      "A URDF or a scene that is ready to run, with its goals and the defaults of simulate_gdd.");
  softgauss::python::bindSimulation(m, sim);
  softgauss::python::bindModel(sim);
  softgauss::python::bindControl(m, sim);
  softgauss::python::bindDynamics(sim);
  softgauss::python::bindQuantities(sim);
  softgauss::python::bindDerivatives(sim);
  softgauss::python::bindRollout(m);
  softgauss::python::bindPlans(m);
  softgauss::python::bindReprs(m, sim);
  softgauss::python::bindEnvironments(m);
}
