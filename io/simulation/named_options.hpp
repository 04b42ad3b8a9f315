// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Options of simulate_gdd that say what is loaded and how it is stepped, by name: what Python
/// takes as keywords and a sweep as keys. `--step-doubling` is `step_doubling`, `--package-path`
/// may be given many times and is `package_paths`.

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "softgauss/io/simulation/options.hpp"

namespace softgauss {

/// A flag, a number, a word, a list of words, or numbers by name.
using OptionValue = std::variant<bool, double, std::string, std::vector<std::string>,
                                 std::map<std::string, double>>;

class NamedOption {
 public:
  /// Of all, by their names.
  static const std::vector<NamedOption>& all();
  /// Null where there is none of that name.
  static const NamedOption* find(const std::string& name);

  const char* name;
  const char* expected;  ///< "a number", "one of pyramidal, elliptic"
  bool ofUrdf;           ///< a scene file says it itself
  bool ofScene;          ///< `options` of a scene file may say it too

  /// Sets it. Returns whether the value is of a kind, and one, that the option takes; the options
  /// are as they were where it is not.
  bool (*set)(const OptionValue& value, SimulationOptions& options);
};

/// A budget of a control, in iterations ("20") or in time ("200us", "1.5ms", "0.001s"). Returns
/// whether the text is one; the options are as they were where it is not.
bool setBudget(const std::string& text, SimulationOptions& options);

}  // namespace softgauss
