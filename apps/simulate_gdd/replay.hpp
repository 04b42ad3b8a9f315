// SPDX-License-Identifier: Apache-2.0
#pragma once

/// --view and --plot: the run, recorded as it goes, written as a page and as drawings at its end.

#include <optional>

#include "apps/simulate_gdd/scene.hpp"
#include "softgauss/io/replay/page.hpp"
#include "softgauss/io/replay/plot.hpp"
#include "softgauss/io/simulation/run_recording.hpp"
#include "softgauss/io/summary.hpp"

namespace softgauss::app {

/// The run of --view-with, or nothing. Throws ModelError.
std::string runBeside(const SimulateOptions& options);

/// A plan as a run that goes from knot to knot, to be shown beside the one that acts it out.
std::string planBeside(const PlanControl& plan, const Scene& scene);

class Replay {
 public:
  /// The stages of the initial state are in `start`. Throws ModelError when an output cannot be
  /// made.
  Replay(const SimulateOptions& options, const Scene& scene,
         const std::vector<std::unique_ptr<gdd::Goal>>& goals, const gdd::GoalContext& start);

  void addStep(const io::StepRecord& record, const Data& data,
               const std::vector<Snapshot::ContactForce>& contacts) {
    if (!recording_) return;
    if (plan_) showCost(record);
    recording_->addStep(record, data, contacts);
  }
  /// The run goes on from `time` [s], which lies back.
  void rewind(double time) {
    if (recording_) recording_->rewind(time);
  }
  template <class Archive>
  void archive(Archive& a) {
    if (recording_) a(*recording_);
  }
  /// The final state, whose stages are in `data`; `message` says why the run ended early. Returns
  /// what could not be written.
  std::vector<std::string> finish(const io::StepRecord& last, const Data& data,
                                  const io::Summary& summary, const std::string& message);
  /// What cannot be shown, and why.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// What finish() has written and how long that took, a line each.
  const std::string& written() const { return written_; }

 private:
  /// What the step costs by the plan, and what it was to cost.
  void showCost(const io::StepRecord& record);

  std::optional<io::Recording> recording_;
  std::optional<io::ReplayPage> page_;
  std::optional<io::Plot> plot_;
  std::shared_ptr<PlanControl> plan_;
  std::filesystem::path view_, drawing_;
  std::vector<std::string> warnings_;
  std::string written_;
};

}  // namespace softgauss::app
