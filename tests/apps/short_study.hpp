// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Arguments of accuracy_cost that several tests share.

#include <string>
#include <vector>

#include "tests/apps/process.hpp"

namespace softgauss::test {

/// A short study: steps of at least 1 ms, each run once.
inline std::vector<std::string> study(const std::string& problem, const std::string& out,
                                      const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{
      "--scene",   problem, "--out",        out, "--robots", dataFile("robots"),
      "--repeats", "0",     "--most-steps", "32"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace softgauss::test
