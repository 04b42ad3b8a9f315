// SPDX-License-Identifier: Apache-2.0
#include "apps/python/arrays.hpp"

#include <algorithm>

namespace softgauss::python {
namespace {

std::string shapeText(const std::vector<py::ssize_t>& shape) {
  std::string text = "(";
  for (const py::ssize_t n : shape) text += std::to_string(n) + (shape.size() == 1 ? "," : ", ");
  if (shape.size() > 1) text.resize(text.size() - 2);
  return text + ")";
}

}  // namespace

std::vector<std::pair<std::string, py::object>> namedOf(const py::handle& given,
                                                        const std::string& name) {
  if (!py::hasattr(given, "keys"))
    throw py::type_error(name + ": found " + py::repr(given).cast<std::string>() +
                         ", expected a dict {name: numbers}");
  std::vector<std::pair<std::string, py::object>> named;
  for (const auto& [key, value] : py::dict(py::reinterpret_borrow<py::object>(given)))
    named.emplace_back(valueOf<std::string>(key, name, "a name, a string, as key"),
                       py::reinterpret_borrow<py::object>(value));
  return named;
}

Numbers numbersOf(const py::handle& given, const std::string& name,
                  const std::vector<py::ssize_t>& shape, const std::string& shapeInWords) {
  const Numbers array = Numbers::ensure(given);
  if (!array) {
    PyErr_Clear();
    throw py::type_error(name + ": found " + py::repr(given).cast<std::string>() +
                         ", expected numbers");
  }
  const std::vector<py::ssize_t> found(array.shape(), array.shape() + array.ndim());
  if (found != shape)
    throw py::value_error(name + ": found shape " + shapeText(found) + ", expected " +
                          shapeInWords + " = " + shapeText(shape));
  return array;
}

VectorX vectorOf(const py::handle& given, const std::string& name, Eigen::Index size,
                 const std::string& sizeInWords) {
  const Numbers array = numbersOf(given, name, {size}, "(" + sizeInWords + ",)");
  return Eigen::Map<const VectorX>(array.data(), size);
}

void readInto(VectorX& x, const py::handle& given, const std::string& name,
              const std::string& sizeInWords) {
  const VectorX read = vectorOf(given, name, x.size(), sizeInWords);
  x = read;  // copied
}

Vector3 vector3Of(const py::handle& given, const std::string& name) {
  const Numbers array = numbersOf(given, name, {3}, "(3,)");
  return Eigen::Map<const Vector3>(array.data());
}

py::array viewOf(VectorX& x, const py::object& owner) {
  return py::array_t<double>({x.size()}, {static_cast<py::ssize_t>(sizeof(double))}, x.data(),
                             owner);
}

}  // namespace softgauss::python
