// SPDX-License-Identifier: Apache-2.0
#pragma once

/// --play: what was done to a live run is done again, at the same steps.

#include "apps/live/event_file.hpp"
#include "apps/live/hands.hpp"
#include "apps/simulate_gdd/companion.hpp"

namespace softgauss::app {

class PlayRun final : public Companion {
 public:
  /// Throws ModelError where the file is none of this run.
  PlayRun(const std::filesystem::path& file, live::Hands& hands, double timestep);

  long steps() const { return file_.steps; }  ///< of the run that was recorded

  /// Throws ModelError where the run refuses what it accepted when it was recorded.
  bool before(long taken) override;
  void after(const SeenStep&, const Verdict&) override {}
  void tell(const std::string&) override {}
  void finish(long) override {}

 private:
  std::filesystem::path path_;
  live::Hands& hands_;
  live::EventFile file_;
  std::size_t next_ = 0;
};

}  // namespace softgauss::app
