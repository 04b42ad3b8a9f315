// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/sealed.hpp"
#include "softgauss/engine/model/model_hash.hpp"
#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/output_file.hpp"

namespace softgauss::app {
namespace {

constexpr std::string_view kCheckpointKind = "SGCHECK\n";
constexpr std::uint32_t kCheckpointVersion = 7;
constexpr std::uintmax_t kLargestCheckpoint = std::uintmax_t{1}
                                              << 30;  // [bytes] a recording is less

RunIdentity identityOf(const SimulateOptions& options, const Model& model,
                       const io::RunOrigin& origin) {
  RunIdentity identity;
  identity.model = hash(model);
  identity.settings = options.settings;
  for (const io::RunOrigin::File& file : origin.files) identity.files.push_back(file.sha256);
  identity.build = fmt::format("softgauss {}, commit {}, {}, on {}", SOFTGAUSS_VERSION,
                               origin.commit, origin.compiler, origin.processor);
  return identity;
}

std::string settingText(const std::pair<std::string, std::string>& setting) {
  return setting.second.empty() || setting.second == "true" ? setting.first
                                                            : setting.first + " " + setting.second;
}

}  // namespace

std::string differenceOf(const RunIdentity& saved, const RunIdentity& run) {
  const auto missing = [](const auto& list, const auto& other) {
    return std::find_if(list.begin(), list.end(), [&](const auto& setting) {
      return std::find(other.begin(), other.end(), setting) == other.end();
    });
  };
  const auto was = missing(saved.settings, run.settings);
  const auto now = missing(run.settings, saved.settings);
  if (now != run.settings.end() && was != saved.settings.end())
    return fmt::format("found a run with {}, expected one with {}", settingText(*was),
                       settingText(*now));
  if (was != saved.settings.end())
    return fmt::format("found a run with {}: give the options with which it began",
                       settingText(*was));
  if (now != run.settings.end())
    return fmt::format("found a run without {}: give the options with which it began",
                       settingText(*now));
  if (saved.files != run.files)
    return "found a run of other files: the model, its goals or its table have changed since";
  if (saved.model != run.model) return "found a run of another model";
  return "";
}

std::string checkpointBytes(const RunIdentity& identity, std::string_view content) {
  ByteWriter writer;
  writer(identity, std::string(content));
  return sealed(kCheckpointKind, kCheckpointVersion, writer.bytes());
}

std::pair<RunIdentity, std::string> readCheckpoint(std::string_view bytes) {
  ByteReader reader(unsealed(kCheckpointKind, kCheckpointVersion, bytes));
  std::pair<RunIdentity, std::string> read;
  reader(read.first, read.second);
  reader.expectEnd();
  return read;
}

Checkpoints::Checkpoints(const SimulateOptions& options, const Model& model,
                         const io::RunOrigin& origin)
    : options_(options) {
  if (!options.resume.empty() || asked()) identity_ = identityOf(options, model, origin);
  if (options.resume.empty()) return;
  const std::string bytes = io::detail::readInput(
      options.resume.string(), "a checkpoint of simulate_gdd", kLargestCheckpoint);
  try {
    auto [saved, content] = readCheckpoint(bytes);
    if (const std::string difference = differenceOf(saved, identity_); !difference.empty())
      refuse(difference);
    if (saved.build != identity_.build)
      warning_ = fmt::format("{} was written by {}, and this is {}: the bits may differ",
                             options.resume.string(), saved.build, identity_.build);
    content_ = std::move(content);
  } catch (const BytesError& error) {
    refuse(error.what());
  }
}

void Checkpoints::refuse(const std::string& problem) const {
  throw ModelError({options_.resume.string(), 0}, "checkpoint", problem);
}

void Checkpoints::beginAt(double time) {
  // On a grid of its own, so that a run that was broken writes when the unbroken one does.
  constexpr double kRounding = 1e-9;
  const double every = options_.checkpointEvery;
  next_ = (std::floor(time / every + kRounding) + 1.0) * every - kRounding * every;
}

void Checkpoints::write(const std::string& content, double time) {
  io::detail::OutputFile file(options_.checkpoint, "checkpoint");
  file.write(checkpointBytes(identity_, content));
  file.commit();
  beginAt(time);
}

}  // namespace softgauss::app
