// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/model.hpp"

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
  // What floats may have the name of its link, which may be that of a joint too.
  int found = -1;
  for (int b = bodyCount() - 1; b > 0; --b)
    if (jointNames[static_cast<std::size_t>(b)] == jointName &&
        (found < 0 || bodies[static_cast<std::size_t>(b)].joint != JointKind::floating))
      found = b;
  return found;
}

}  // namespace softgauss
