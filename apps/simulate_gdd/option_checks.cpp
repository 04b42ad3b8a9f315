// SPDX-License-Identifier: Apache-2.0
/// What options ask for, looked at before anything is loaded or written.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "apps/simulate_gdd/options.hpp"
#include "softgauss/io/inputs.hpp"
#include "softgauss/io/mcap_log.hpp"
#include "softgauss/io/output.hpp"

namespace softgauss::app {
namespace {

constexpr double kLongestStep = 1.0;  // [s]
constexpr double kMostStepsOfARun = 1e9;

}  // namespace

namespace {

/// Tables are CSV, whatever they are called, but for a log as MCAP; names of other formats are a
/// mistake.
void checkTableNames(const SimulateOptions& options) {
  for (const auto& [option, file] :
       {std::pair{"--log", &options.log}, std::pair{"--contacts", &options.contacts}}) {
    std::string ending = file->extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    for (const char* other : {".mcap", ".bag", ".json", ".html", ".gz", ".zip", ".h5", ".parquet"})
      if (ending == other && !(file == &options.log && io::isMcap(options.log)))
        throw UsageError(fmt::format(
            "{}: found '{}', expected the name of a CSV file, such as {}", option, file->string(),
            std::filesystem::path(*file).replace_extension(".csv").string()));
  }
}

}  // namespace

void checkOutputs(const SimulateOptions& options, const std::vector<std::filesystem::path>& read) {
  checkTableNames(options);
  std::vector<std::pair<std::string, std::filesystem::path>> files = {
      {"MODEL", options.model}, {"--goals", options.goals},   {"--torques", options.torques},
      {"--play", options.play}, {"--resume", options.resume}, {"--view-with", options.viewWith}};
  for (const std::filesystem::path& file : read) files.emplace_back(file.string(), file);
  // Standard input is no output.
  std::erase_if(files, [](const auto& file) { return file.second == io::kStandardInput; });
  const std::size_t inputs = files.size();
  for (const auto& [option, file] : {std::pair{"--log", &options.log},
                                     {"--contacts", &options.contacts},
                                     {"--summary", &options.summary},
                                     {"--view", &options.view},
                                     {"--plot", &options.plot},
                                     {"--record", &options.record},
                                     {"--checkpoint", &options.checkpoint}})
    files.emplace_back(option, *file);
  const auto same = [](const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code error;
    const auto place = [&](const std::filesystem::path& file) {
      return std::filesystem::weakly_canonical(std::filesystem::absolute(file, error), error);
    };
    return !a.empty() && !b.empty() &&
           (place(a) == place(b) || std::filesystem::equivalent(a, b, error) ||
            (io::isStandardOutput(a) && io::isStandardOutput(b)));
  };
  for (std::size_t out = inputs; out < files.size(); ++out)
    for (std::size_t other = 0; other < out; ++other)
      if (same(files[out].second, files[other].second) &&
          !(files[out].first == "--checkpoint" && files[other].first == "--resume"))
        throw UsageError(
            fmt::format("{} would overwrite {}", files[out].first, files[other].first));
  // All before any is overwritten; a folder of drawings is made when its time comes.
  for (std::size_t out = inputs; out < files.size(); ++out) {
    const auto& [option, file] = files[out];
    std::error_code error;
    const bool folder =
        option == "--plot" && (std::filesystem::is_directory(file, error) || !file.has_extension());
    if (!file.empty() && !folder) io::expectWritable(file, option);
  }
}

void checkSteps(const SimulateOptions& options, double timestep, const SourceLocation& where) {
  const bool ofFile = where.line > 0;
  const auto fail = [&](const std::string& problem) {
    if (ofFile) throw ModelError(where, "key 'timestep'", "found " + problem);
    throw UsageError(problem);
  };
  if (timestep > kLongestStep)
    fail(fmt::format("{}{}{} expected at most {} s", ofFile ? "" : "--timestep ", timestep,
                     ofFile ? "," : ":", kLongestStep));
  if (std::isfinite(options.duration) && options.duration / timestep > kMostStepsOfARun)
    fail(fmt::format("{}--duration {} is more than {:g} steps of {} s",
                     ofFile ? fmt::format("{} s: ", timestep) : "", options.duration,
                     kMostStepsOfARun, timestep));
}

bool SimulateOptions::writesToStandardOutput() const {
  return io::isStandardOutput(log) || io::isStandardOutput(contacts) ||
         io::isStandardOutput(summary) || io::isStandardOutput(view) || io::isStandardOutput(plot);
}

}  // namespace softgauss::app
