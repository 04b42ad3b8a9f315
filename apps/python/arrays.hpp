// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Numbers that come from Python, checked, and views that go there.

#include <string>
#include <utility>
#include <vector>

#include "apps/python/module.hpp"
#include "softgauss/engine/core/types.hpp"

namespace softgauss::python {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// A value of this type. Throws TypeError "runs: found 3.0, expected a whole number".
template <class T>
T valueOf(const py::handle& given, const std::string& name, const char* expected) {
  try {
    return given.cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(name + ": found " + py::repr(given).cast<std::string>() + ", expected " +
                         expected);
  }
}

/// What a mapping from names holds, in its order. Throws TypeError.
std::vector<std::pair<std::string, py::object>> namedOf(const py::handle& given,
                                                        const std::string& name);

/// An array of this shape, without a copy where it is one of doubles in rows. Throws TypeError
/// where these are no numbers, ValueError "q0: found shape (3, 7), expected (runs, nq) = (10, 7)".
Numbers numbersOf(const py::handle& given, const std::string& name,
                  const std::vector<py::ssize_t>& shape, const std::string& shapeInWords);

/// A vector of this length.
VectorX vectorOf(const py::handle& given, const std::string& name, Eigen::Index size,
                 const std::string& sizeInWords);
/// Writes such a vector into the memory of x: views of it stay good.
void readInto(VectorX& x, const py::handle& given, const std::string& name,
              const std::string& sizeInWords);
Vector3 vector3Of(const py::handle& given, const std::string& name);

/// A view of a vector's memory, which `owner` keeps.
py::array viewOf(VectorX& x, const py::object& owner);

}  // namespace softgauss::python
