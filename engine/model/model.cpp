// SPDX-License-Identifier: Apache-2.0
#include "engine/model/model.hpp"

#include <algorithm>

namespace softgauss {

double Model::totalMass() const {
  double sum = 0.0;
  for (const Body& body : bodies) sum += body.mass;
  return sum;
}

int Model::findFrame(const std::string& frameName) const {
  const auto it = std::find_if(frames.begin(), frames.end(),
                               [&](const Frame& f) { return f.name == frameName; });
  return it == frames.end() ? -1 : static_cast<int>(it - frames.begin());
}

int Model::findJoint(const std::string& jointName) const {
  const auto it = std::find(jointNames.begin() + 1, jointNames.end(), jointName);
  return it == jointNames.end() ? -1 : static_cast<int>(it - jointNames.begin());
}

}  // namespace softgauss
