// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/softness.hpp"

#include <fmt/format.h>

namespace softgauss::io::mjcf {

void Softness::read(const Element& element, const char* solrefName, const char* solimpName) {
  element.read(solrefName, solref, 1);
  element.read(solimpName, solimp, 1);
}

Impedance Softness::impedance(const Element& element) const {
  Impedance result;
  if (solref[0] > 0.0 && solref[1] > 0.0) {
    result.timeConstant = solref[0];
    result.dampingRatio = solref[1];
  } else if (solref[0] <= 0.0 && solref[1] <= 0.0) {
    result.direct = ReferenceSpring{-solref[0], -solref[1]};
  } else {
    element.fail(
        fmt::format("solref is {:g} {:g}, expected a time constant and a damping ratio, "
                    "both above 0, or a stiffness and a damping, both negative",
                    solref[0], solref[1]));
  }
  result.dMin = solimp[0];
  result.dMax = solimp[1];
  result.width = solimp[2];
  result.midpoint = solimp[3];
  result.power = solimp[4];
  for (const int i : {0, 1, 3})
    if (!(solimp[static_cast<std::size_t>(i)] >= 0.0 && solimp[static_cast<std::size_t>(i)] <= 1.0))
      element.fail(fmt::format("solimp holds {:g} at place {}, expected 0 to 1",
                               solimp[static_cast<std::size_t>(i)], i + 1));
  if (!(result.width >= 0.0) || !(result.power >= 1.0))
    element.fail(
        fmt::format("solimp has a width of {:g} and a power of {:g}, expected at least 0 "
                    "and 1",
                    result.width, result.power));
  return result;
}

}  // namespace softgauss::io::mjcf
