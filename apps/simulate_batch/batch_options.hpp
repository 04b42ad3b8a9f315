// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The command line of simulate_batch.

#include <filesystem>
#include <optional>

namespace softgauss::app {

struct BatchOptions {
  std::filesystem::path sweep;
  std::filesystem::path out;  ///< folder
  int threads = 0;            ///< 0: all of the machine; one under mpirun
  bool checkpoint = false;
  bool quiet = false;
  std::optional<long> only;    ///< repeat this run alone
  std::filesystem::path view;  ///< of that run
};

/// Nothing when the program is done already (--help, --version). Throws UsageError.
std::optional<BatchOptions> parseBatchCommandLine(int argc, char** argv);

}  // namespace softgauss::app
