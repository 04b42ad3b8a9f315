// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A sweep file and what simulate_batch makes of it.

#include <nlohmann/json.hpp>

#include "tests/apps/process.hpp"

namespace softgauss::test {

using Json = nlohmann::json;

struct Batch {
  io::TempFolder folder;
  std::string sweep;
  explicit Batch(const std::string& text) : sweep(folder.write("sweep.yaml", text)) {}
  std::string out(const std::string& name) const { return (folder.path() / name).string(); }
  Outcome run(const std::string& name, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments = {sweep, "--quiet", "--out", out(name)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram("simulate_batch", arguments);
  }
  std::string table(const std::string& name) const { return readFile(out(name) + "/runs.csv"); }
  Json summary(const std::string& name) const {
    return Json::parse(readFile(out(name) + "/summary.json"));
  }
};

}  // namespace softgauss::test
