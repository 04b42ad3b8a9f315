// SPDX-License-Identifier: Apache-2.0
#include "apps/live/drag.hpp"

#include <fmt/format.h>

namespace softgauss::live {

Drag::Drag(const Model& model, int number)
    : reach(model, model.frames.back().name, Vector3::Zero()),
      name_(fmt::format("drag {}", number)) {
  end();
}

void Drag::begin(const Model& model, const std::string& link, const Vector3& p_FP,
                 const Vector3& p_WTarget, double weight) {
  reach = gdd::Reach(model, link, p_WTarget, p_FP);
  reach.weight = weight;
  startTime = -kInfinity;
}

}  // namespace softgauss::live
