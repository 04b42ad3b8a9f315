// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A search among the minima of a plan.
///
/// What touches, leans on a stop or sticks has a minimum for each order in which it does so, many
/// within some per cent of each other, and phases I and F end at the one they start near. A search
/// changes the best plan so far by smooth random motions of every degree of freedom,
///
///   δq(t) = Σ_k c_k (1 − cos(k π t/T))/k²,   k = 1 … 4,   c_k normal, of deviation σ
///
/// so that its accelerations, not its states, change at the start; σ is drawn between a fiftieth of
/// `reach` and `reach`, evenly in its logarithm. It plans from there and keeps what is better. The
/// same seed gives the same plan.

#include <cstdint>
#include <random>
#include <vector>

#include "softgauss/engine/core/types.hpp"

namespace softgauss::planning {

struct PlanSearch {
  int tries = 0;
  double reach = 0.5;  ///< largest σ [m, rad]
  std::uint64_t seed = 1;
};

/// Normal numbers that are the same with every standard library (Box and Muller).
class NormalNumbers {
 public:
  explicit NormalNumbers(std::uint64_t seed) : bits_(seed) {}
  double uniform();  ///< in (0, 1)
  double next();     ///< of deviation 1

 private:
  std::mt19937_64 bits_;
};

/// Adds δq̈ of the search to accelerations, `step` seconds apart.
void addSmoothMotion(NormalNumbers& random, double sigma, double step, std::vector<VectorX>& a);

}  // namespace softgauss::planning
