// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/replay.hpp"

#include <fmt/format.h>

#include <map>

namespace softgauss::app {
namespace {

/// A mesh collides as its convex hull, so that is what is shown.
std::vector<std::shared_ptr<const Mesh>> collidingHulls(const Scene& scene) {
  std::vector<std::shared_ptr<const Mesh>> hulls(scene.model.geometries.size());
  std::map<const collision::ConvexHull*, std::shared_ptr<const Mesh>> made;
  for (std::size_t i = 0; i < hulls.size(); ++i) {
    const collision::ConvexHull* hull = scene.contacts->hull(static_cast<int>(i));
    if (!hull) continue;
    std::shared_ptr<const Mesh>& mesh = made[hull];
    if (!mesh) mesh = std::make_shared<const Mesh>(collision::triangulated(*hull));
    hulls[i] = mesh;
  }
  return hulls;
}

}  // namespace

Replay::Replay(const SimulateOptions& options, const Scene& scene,
               const std::vector<std::unique_ptr<gdd::Goal>>& goals,
               const gdd::GoalContext& start) {
  if (!options.view.empty()) page_.emplace(options.view);
  if (!options.plot.empty()) plot_.emplace(options.plot);
  if (!page_ && !plot_) return;
  recording_.emplace(scene.model, goals, start);
  recording_->command = options.commandLine;
  recording_->reserve(static_cast<std::size_t>(options.duration / scene.model.options.timestep),
                      options.duration);
  if (page_) recording_->hulls = collidingHulls(scene);
}

std::string Replay::finish(const Data& data, const State& last, const io::Summary& summary,
                           const std::string& message) {
  if (!recording_) return {};
  recording_->finish(data, last);
  recording_->outcome = {summary.outcome, message};
  recording_->facts = summary.facts();
  recording_->warnings = summary.warnings;
  const std::string generator = fmt::format("softgauss {}", summary.version);
  try {
    if (page_) page_->write(*recording_, generator);
    if (plot_) plot_->write(*recording_);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

}  // namespace softgauss::app
