// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How programs take their arguments: what is wrong with them is a UsageError.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "apps/shared/standard_streams.hpp"
#include "apps/simulate_gdd/options.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::app {

/// What to tell of an option that there is not, with the nearest that there is; nothing where all
/// that were given are known.
inline std::optional<std::string> unknownOption(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  for (const std::string& given : app.remaining()) {
    const std::string name = given.substr(0, given.find('='));
    if (!name.starts_with("--")) continue;
    const std::string near = io::detail::suggestion(name, names);
    return fmt::format("found the unknown option {}{}", name,
                       near.empty() ? ", see --help for those that there are" : near);
  }
  return std::nullopt;
}

/// Reads them as CLI::App::parse() does. False where the program is done already: --help and
/// --version have been answered. Throws UsageError.
template <class... Arguments>
bool parses(CLI::App& app, Arguments&&... arguments) {
  try {
    app.parse(std::forward<Arguments>(arguments)...);
    return true;
  } catch (const CLI::Success& success) {
    std::ostringstream text;
    app.exit(success, text, text);
    print(stdout, text.str());
    return false;
  } catch (const CLI::ParseError& error) {
    throw UsageError(unknownOption(app).value_or(error.what()));
  }
}

}  // namespace softgauss::app
