// SPDX-License-Identifier: Apache-2.0
#pragma once

/// How a live run goes, for its pages: a few times a second.

#include <string>
#include <vector>

#include "apps/live/hands.hpp"
#include "softgauss/io/log.hpp"

namespace softgauss::live {

/// Times of the last steps: a window that slides.
class StepTimes {
 public:
  explicit StepTimes(int window) : kept_(static_cast<std::size_t>(window)) {}

  void add(double us) {
    kept_[next_] = us;
    next_ = (next_ + 1) % kept_.size();
    if (count_ < kept_.size()) ++count_;
  }
  struct Spread {
    double median = 0.0, p99 = 0.0, most = 0.0;  ///< [µs]
  };
  Spread spread();

 private:
  std::vector<double> kept_, sorted_;
  std::size_t next_ = 0, count_ = 0;
};

/// How far a goal in force is from what it wants.
struct GoalError {
  std::string name, unit;
  double value;
};

struct Status {
  double time = 0.0;  ///< of the state [s]
  long steps = 0;     ///< taken
  bool paused = false;
  double factor = 1.0;          ///< that is asked for
  double realTimeFactor = 0.0;  ///< that is reached
  StepTimes::Spread stepUs;
  io::StepRecord record;  ///< of the last step
  bool certified = true;  ///< all solves for goals since the last status
  Vector3 gravity = Vector3::Zero();
  std::vector<std::string> effectsOff;
  std::vector<std::string> told;       ///< the last few messages
  std::vector<std::string> fallen;     ///< robots that lie where they stood
  std::vector<std::string> saturated;  ///< controls at their bounds
  std::vector<std::string> atLimits;   ///< joints at an end of their range
  std::vector<GoalError> errors;
  std::vector<double> joints;   ///< positions, in the order of Names::joints
  std::vector<double> targets;  ///< where a posture seeks them; empty: nowhere
  int pages = 0;
  int loads = 0;  ///< LivePage::loads of the run
};

/// What a page knows from the start, besides the scene.
struct LivePage {
  std::string token;     ///< that it needs; empty: none
  int loads = 0;         ///< how often the files were read: a page of another time begins anew
  bool passive = false;  ///< nothing drives the run
  double weight = 0.0;   ///< of all that moves [N], by which it scales arrows
};

std::string statusMessage(const Status& status, const Hands& hands);

/// The page's header: where the run is, joints with their ranges, effects and states.
std::string liveHeader(const Names& names, const LivePage& page);

}  // namespace softgauss::live
