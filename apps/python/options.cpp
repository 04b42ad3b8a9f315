// SPDX-License-Identifier: Apache-2.0
#include "apps/python/options.hpp"

#include "softgauss/io/simulation/named_options.hpp"

namespace softgauss::python {
namespace {

/// As an option takes it; nothing where no option is of this kind.
std::optional<OptionValue> optionValue(const py::handle& given) {
  if (given.is_none()) return OptionValue(std::string("none"));
  if (py::isinstance<py::bool_>(given)) return OptionValue(given.cast<bool>());
  if (py::isinstance<py::str>(given)) return OptionValue(given.cast<std::string>());
  try {
    if (py::hasattr(given, "__fspath__"))
      return OptionValue(given.attr("__fspath__")().cast<std::string>());
    if (py::hasattr(given, "keys")) return OptionValue(given.cast<std::map<std::string, double>>());
    if (py::isinstance<py::sequence>(given)) {
      std::vector<std::string> words;
      const py::object path = py::module_::import("os").attr("fspath");
      for (const py::handle& item : given) words.push_back(path(item).cast<std::string>());
      return OptionValue(words);
    }
    return OptionValue(given.cast<double>());
  } catch (const py::cast_error&) {
    return std::nullopt;
  } catch (const py::error_already_set& error) {
    if (error.matches(PyExc_TypeError)) return std::nullopt;
    throw;
  }
}

/// A flag that is none of the program's, which has --passive, --servos and --view; null: of another
/// name.
bool SimulationOptions::*ownFlag(const std::string& name) {
  if (name == "without_goals") return &SimulationOptions::withoutGoals;
  if (name == "visual_meshes") return &SimulationOptions::visualMeshes;
  return name == "without_servos" ? &SimulationOptions::withoutServos : nullptr;
}

/// The option by keyword.
bool set(const std::string& name, const py::handle& given, SimulationOptions& options) {
  const std::optional<OptionValue> value = optionValue(given);
  if (const auto own = ownFlag(name)) {
    const bool* flag = value ? std::get_if<bool>(&*value) : nullptr;
    if (flag) options.*own = *flag;
    return flag != nullptr;
  }
  return value && NamedOption::find(name)->set(*value, options);
}

std::string expectedOf(const std::string& name) {
  if (ownFlag(name)) return "True or False";
  const std::string expected = NamedOption::find(name)->expected;
  if (expected == "true or false") return "True or False";
  return name == "ground" ? "a height [m] or None" : expected;
}

}  // namespace

SimulationOptions optionsFrom(const py::kwargs& keywords) {
  SimulationOptions options;
  for (const auto& [key, value] : keywords) {
    const auto name = key.cast<std::string>();
    if (!ownFlag(name) && !NamedOption::find(name)) {
      std::string known;
      for (const NamedOption& other : NamedOption::all()) known += std::string(other.name) + ", ";
      throw py::type_error("found the option '" + name + "', expected one of " + known +
                           "without_goals, without_servos, visual_meshes");
    }
    if (set(name, value, options)) continue;
    const std::string problem =
        name + ": found " + py::repr(value).cast<std::string>() + ", expected " + expectedOf(name);
    // Another word or number than those expected is no mistake of type.
    const bool isWord = py::isinstance<py::str>(value) && problem.find("one of") != problem.npos;
    const bool isNumber =
        py::isinstance<py::float_>(value) && problem.find("number") != problem.npos;
    if (isWord || isNumber) throw py::value_error(problem);
    throw py::type_error(problem);
  }
  return options;
}

}  // namespace softgauss::python
