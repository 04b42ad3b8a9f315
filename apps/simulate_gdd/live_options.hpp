// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The options of live runs: --live, --live-address, --record, --play.

#include <string>
#include <vector>

#include "apps/simulate_gdd/options.hpp"

namespace CLI {
class App;
}

namespace softgauss::app {

/// The arguments in order, where `--live` without a port has the default one.
std::vector<std::string> argumentsOf(int argc, char** argv);
void addLiveOptions(CLI::App& app, SimulateOptions& options);
/// What they mean together with the others, which are read. Throws UsageError.
void finishLiveOptions(const CLI::App& app, SimulateOptions& options);

}  // namespace softgauss::app
