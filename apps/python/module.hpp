// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The parts of the Python module, each bound in a file of its own.

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

namespace softgauss::python {

namespace py = pybind11;

class Held;
using HeldClass = py::class_<Held>;

void bindErrors(py::module_& m);
void bindGoals(py::module_& m);
void bindModel(HeldClass& sim);        ///< sizes and names
void bindDynamics(HeldClass& sim);     ///< forward, inverse, Jacobians
void bindQuantities(HeldClass& sim);   ///< energy, momentum, centre of mass, configurations
void bindDerivatives(HeldClass& sim);  ///< of dynamics and of a step
void bindControl(py::module_& m, HeldClass& sim);
void bindSimulation(py::module_& m, HeldClass& sim);
void bindRollout(py::module_& m);
void bindPlans(py::module_& m);
void bindReprs(py::module_& m, HeldClass& sim);  ///< after all of these

}  // namespace softgauss::python
