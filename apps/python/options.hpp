// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Options of Python's keywords.

#include "apps/python/module.hpp"
#include "softgauss/io/simulation/options.hpp"

namespace softgauss::python {

/// Keywords are those options of simulate_gdd that say how a model is loaded, with underscores. An
/// unknown one, or a value of another type, is a TypeError; a word that is none of the choices a
/// ValueError.
SimulationOptions optionsFrom(const py::kwargs& keywords);

}  // namespace softgauss::python
