// SPDX-License-Identifier: Apache-2.0
#pragma once

/// --live: the run keeps pace with the clock, shows itself to pages and does what they ask.

#include <memory>
#include <optional>
#include <string>

#include "apps/live/event_file.hpp"
#include "apps/live/hands.hpp"
#include "apps/live/pace.hpp"
#include "apps/live/server.hpp"
#include "apps/live/status.hpp"
#include "apps/simulate_gdd/companion.hpp"
#include "apps/simulate_gdd/scene.hpp"
#include "softgauss/io/replay/recording.hpp"

namespace softgauss::app {

class LiveRun final : public Companion {
 public:
  /// The stages of the initial state are in `start`. Throws UsageError where the port cannot be had
  /// and ModelError where the record cannot be written.
  LiveRun(const SimulateOptions& options, const Scene& scene, live::Hands& hands,
          const gdd::GoalDirectedController& controller, const gdd::GoalContext& start);
  ~LiveRun() override;

  /// Where the page is, a line or two for a person; the first is "live: ADDRESS".
  std::string announcement() const override;

  /// Where the step that it let go last was refused, the run pauses.
  bool before(long taken) override;
  void after(const SeenStep& step, const Verdict& verdict) override;
  void tell(const std::string& message) override;
  bool reloads() const override { return options_.live->reload; }
  void finish(long taken) override;

 private:
  bool takeEvents();
  std::string reload();
  void pause();
  void showErrors(const GoalRecord& goals);
  void showState();
  void showFrame(const Data& data, const std::vector<Snapshot::ContactForce>& contacts,
                 double time);
  void showStatus();

  const SimulateOptions& options_;
  const Model& model_;
  const State& state_;
  live::Hands& hands_;
  const gdd::GoalDirectedController& controller_;
  io::Recording scene_;   ///< what a page has from the start
  io::FrameTrack frame_;  ///< the instant that is sent
  Data shown_;            ///< its kinematics are of the state where no step leads to it
  Snapshot snapshot_;
  std::vector<std::optional<gdd::GoalMark>> marks_;
  std::vector<Snapshot::ContactForce> contacts_;  ///< of the last step
  std::vector<std::pair<live::Sender, live::Event>> asked_;
  std::optional<live::EventWriter> record_;
  live::Pace pace_;
  live::StepTimes times_;
  live::Status status_;
  std::unique_ptr<live::Server> server_;
  long taken_ = 0;
  long begun_ = -1;  ///< steps before the one that was let go last
  live::Pace::Clock::time_point nextFrame_{}, nextStatus_{};
};

}  // namespace softgauss::app
