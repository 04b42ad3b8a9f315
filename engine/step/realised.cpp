// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/realised.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/step/substep_workspace.hpp"

namespace softgauss {

double deviation(const Model& model, const Data& data, bool follows, const StepControl* control,
                 const VectorX& moved, const VectorX* aim) {
  const bool acts = control && control->acts();
  const std::span<const std::uint8_t> of =
      control ? control->controlled() : std::span<const std::uint8_t>{};
  double worst = 0.0, most = 1.0;
  for (const int t : data.active.trees()) {
    const Tree& tree = model.trees[idx(t)];
    if (data.parts && data.parts->leaves(tree.rootBody)) continue;
    const VectorX& a = aim && (of.empty() || of[idx(t)] != 0) ? *aim : data.forward.a;
    const bool counts =
        !follows || !data.parts->substepSelection.free[idx(t)] || (acts && tree.actuated);
    for (int i = tree.firstDof; i < tree.dofEnd; ++i) {
      most = std::max(most, std::abs(a[i]));
      if (counts) worst = std::max(worst, std::abs(moved[i] - a[i]));
    }
  }
  return worst / most;
}

}  // namespace softgauss
