// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How programs take their arguments: what is wrong with them is a UsageError.

#include <CLI/CLI.hpp>
#include <sstream>
#include <utility>

#include "apps/shared/standard_streams.hpp"
#include "apps/simulate_gdd/options.hpp"

namespace softgauss::app {

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
    throw UsageError(error.what());
  }
}

}  // namespace softgauss::app
