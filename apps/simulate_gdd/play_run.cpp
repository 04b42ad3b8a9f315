// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/play_run.hpp"

#include <fmt/format.h>

namespace softgauss::app {

PlayRun::PlayRun(const std::filesystem::path& file, live::Hands& hands, double timestep)
    : path_(file), hands_(hands), file_(live::readEvents(file, hands.names(), timestep)) {}

bool PlayRun::before(long taken) {
  for (; next_ < file_.events.size() && file_.events[next_].step <= taken; ++next_) {
    const std::string refused = hands_.apply(file_.events[next_]);
    if (refused.empty()) continue;
    throw ModelError({path_.string(), 0}, fmt::format("event {}", next_ + 1),
                     fmt::format("the run refuses it: {}; expected the model, goals and options "
                                 "with which it was recorded",
                                 refused));
  }
  return true;
}

}  // namespace softgauss::app
