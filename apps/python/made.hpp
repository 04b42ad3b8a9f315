// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Objects whose `__init__` was left out: `Simulation.__new__(Simulation)`.

#include <string>

#include "apps/python/module.hpp"

namespace softgauss::python {

/// Converts from Python what `__init__`, or this module, has made. Anything else of that class is a
/// TypeError: pybind11 alone would hand out memory that nobody has filled.
template <class T>
class MadeCaster : public py::detail::type_caster_base<T> {
 public:
  bool load(py::handle source, bool convert) {
    if (this->typeinfo && PyObject_TypeCheck(source.ptr(), this->typeinfo->type)) {
      auto* object = reinterpret_cast<py::detail::instance*>(source.ptr());
      if (!object->get_value_and_holder(this->typeinfo).value_ptr())
        throw py::type_error(std::string(this->typeinfo->type->tp_name) +
                             ": found an object that was not initialised, expected one that "
                             "__init__ has made");
    }
    return py::detail::type_caster_base<T>::load(source, convert);
  }
};

}  // namespace softgauss::python

/// At global scope, after the class and before the first use of it.
#define SOFTGAUSS_MADE_ONLY(Class) \
  template <>                      \
  class pybind11::detail::type_caster<Class> : public softgauss::python::MadeCaster<Class> {};
