// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/best.hpp"

#include <algorithm>

namespace softgauss::app {

bool sameModel(const Method& method) { return method.cone == Cone::pyramidal; }

Best bestOf(const std::vector<Result>& results, const std::string& problem, double error,
            const std::string& engine) {
  Best best{nullptr, kInfinity};
  for (const Result& r : results) {
    if (r.problem != problem || r.method.engine != engine || !sameModel(r.method)) continue;
    best.referenceError = std::min(best.referenceError, r.referenceError);
    if (r.error <= error && tells(r.referenceError, error) &&
        (!best.result || r.time < best.result->time))
      best.result = &r;
  }
  return best;
}

}  // namespace softgauss::app
