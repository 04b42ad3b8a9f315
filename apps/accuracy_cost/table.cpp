// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace softgauss::app {
namespace {

constexpr const char* kHeader =
    "problem,engine,integrator,label,cone,tolerance,integration_tolerance,warm_start,doubling,"
    "timestep_s,"
    "error_m,orientation_rad,"
    "cpu_s_per_s,energy_drift,momentum_drift,penetration_m,overshoot,reference_error_m,one_step_m";

std::string line(const Result& r) {
  const Method& m = r.method;
  return fmt::format(
      "{},{},{},{},{},{},{},{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:."
      "6g}",
      r.problem, m.engine, m.integrator, m.label,
      m.cone == Cone::elliptic ? "elliptic" : "pyramidal", m.tolerance, m.integrationTolerance,
      m.warmStart ? 1 : 0, m.doubling ? 1 : 0, r.h, r.error, r.orientation, r.time, r.energyDrift,
      r.momentumDrift, r.penetration, r.overshoot, r.referenceError, r.oneStep);
}

bool parse(const std::string& text, Result& r) {
  std::vector<std::string> cells;
  std::istringstream in(text);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  if (cells.size() != 19) return false;
  try {
    const auto number = [&](int i) { return std::stod(cells[static_cast<std::size_t>(i)]); };
    r.problem = cells[0];
    r.method = {cells[1],        cells[2],
                cells[3],        cells[4] == "elliptic" ? Cone::elliptic : Cone::pyramidal,
                number(5),       number(6),
                cells[7] == "1", cells[8] == "1"};
    r.h = number(9), r.error = number(10), r.orientation = number(11), r.time = number(12);
    r.energyDrift = number(13), r.momentumDrift = number(14), r.penetration = number(15);
    r.overshoot = number(16), r.referenceError = number(17), r.oneStep = number(18);
  } catch (const std::exception&) {
    return false;
  }
  return true;
}

}  // namespace

ResultTable::ResultTable(std::filesystem::path file, const std::string& anew) {
  std::ifstream in(file);
  std::string text;
  bool known = false;
  if (in && std::getline(in, text)) known = text == kHeader;
  if (known) {
    while (std::getline(in, text)) {
      Result result;
      // An interrupt may have cut the last line, within its last number too.
      if (!in.eof() && parse(text, result) && result.problem != anew) put(result);
    }
  } else if (in) {
    in.close();
    std::filesystem::rename(file, file.string() + ".old");
  }
  in.close();
  // Written anew, so that no cut line stays.
  out_.open(file);
  if (!out_) throw std::runtime_error("cannot write " + file.string());
  out_ << kHeader << '\n';
  for (const Result& result : results_) out_ << line(result) << '\n';
  out_.flush();
}

std::vector<Result>::iterator ResultTable::find(const std::string& problem, const Method& method,
                                                double h) {
  return std::find_if(results_.begin(), results_.end(), [&](const Result& r) {
    return r.problem == problem && r.method == method && std::abs(r.h - h) < 1e-9 * h;
  });
}

bool ResultTable::has(const std::string& problem, const Method& method, double h, double mostTime) {
  const auto found = find(problem, method, h);
  return found != results_.end() &&
         !(std::isnan(found->error) && found->time < mostTime * (1.0 - 1e-5));
}

void ResultTable::put(const Result& result) {
  const auto old = find(result.problem, result.method, result.h);
  if (old != results_.end())
    *old = result;
  else
    results_.push_back(result);
}

void ResultTable::add(const Result& result) {
  put(result);
  out_ << line(result) << '\n' << std::flush;
}

}  // namespace softgauss::app
