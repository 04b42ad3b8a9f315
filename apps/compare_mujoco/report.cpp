// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/report.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace softgauss::app {
namespace {

using Json = nlohmann::ordered_json;

/// Whether MuJoCo reads the same robot in the URDF.
void printReading(const Json& reading) {
  if (reading.contains("refused")) {
    fmt::print("  the URDF as MuJoCo reads it: {}\n", reading["refused"].get<std::string>());
    return;
  }
  fmt::print("  the URDF as MuJoCo reads it: ");
  for (const auto& difference : reading["differs"])
    fmt::print("\n    {}", difference.get<std::string>());
  if (reading.contains("bodies")) {
    fmt::print("{} bodies, {} of {} shapes; largest differences\n", reading["bodies"].get<int>(),
               reading["shapes"].get<int>(), reading["shapes_ours"].get<int>());
    int column = 0;
    for (const auto& [name, value] : reading.items())
      if (value.is_number_float())
        fmt::print("    {:<20}{:>8.1e}{}", name, value.get<double>(), ++column % 3 ? "" : "\n");
    if (column % 3) fmt::print("\n");
  }
  for (const auto& left : reading["not_read"])
    fmt::print("    not so in MuJoCo: {}\n", left.get<std::string>());
}

}  // namespace

void printComparison(const Json& result) {
  fmt::print("{}, {} dof, {} steps, {}\n", result["model"].get<std::string>(),
             result["dof"].get<int>(), result["steps"].get<int>(),
             result["mujoco_build"].get<std::string>());
  fmt::print("  {:<28}{:>10}{:>10}{:>10}\n", "[µs]", "ours", "MuJoCo", "ratio");
  for (const auto& [name, key] : {std::pair{"step", "step_us"},
                                  {"forward dynamics", "forward_us"},
                                  {"inverse dynamics", "inverse_us"}}) {
    const Json& d = result[key];
    fmt::print("  {:<28}{:>10.3g}{:>10.3g}{:>10.2f}\n", name, d["ours"].get<double>(),
               d["mujoco"].get<double>(), d["ratio"].get<double>());
  }
  for (const auto& [mode, d] : result["run_step_us"].items())
    fmt::print("  {:<28}{:>10.3g}{:>10.3g}{:>10.2f}\n", "step of a run, " + mode,
               d["ours"].get<double>(), d["mujoco"].get<double>(), d["ratio"].get<double>());
  fmt::print("  {:<28}{:>10}{:>10}{:>10}\n", "relative difference", "p50", "p95", "max");
  for (const auto& [name, key] :
       {std::pair{"acceleration", "acceleration_difference"},
        {"  with the same contacts", "acceleration_difference_same_contacts"},
        {"inverse dynamics", "inverse_difference"},
        {"  with the same contacts", "inverse_difference_same_contacts"}}) {
    const Json& d = result[key];
    fmt::print("  {:<28}{:>10.2g}{:>10.2g}{:>10.2g}\n", name, d["p50"].get<double>(),
               d["p95"].get<double>(), d["max"].get<double>());
  }
  fmt::print("  MuJoCo's forces balance to {:.1e}\n",
             result["mujoco_imbalance"]["max"].get<double>());
  fmt::print("  state after 1 s: {:.2g} rad or m; contacts equal in {} steps\n",
             result["state_difference_after_1s"].get<double>(),
             result["contacts"]["steps_with_equal_numbers"].get<int>());
  printReading(result["urdf_reading"]);
  if (const std::string warning = result["mujoco_warning"]; !warning.empty())
    fmt::print("  MuJoCo warns: {}\n", warning);
}

}  // namespace softgauss::app
