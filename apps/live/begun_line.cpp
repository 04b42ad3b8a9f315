// SPDX-License-Identifier: Apache-2.0
#include "apps/live/begun_line.hpp"

#include <algorithm>

namespace softgauss::live {

BegunLine::Point BegunLine::at(double time) const {
  const double T = duration, s = std::clamp((time - startTime) / T, 0.0, 1.0), r = 1.0 - s;
  const Vector3 way = p_target - p_start;
  Point point;
  point.p = p_start + s * s * s * (10.0 + s * (-15.0 + 6.0 * s)) * way +
            T * s * (1.0 + s * s * (-6.0 + s * (8.0 - 3.0 * s))) * v_start +
            0.5 * T * T * s * s * r * r * r * a_start;
  point.v = 30.0 / T * s * s * r * r * way + r * r * (1.0 + s * (2.0 - 15.0 * s)) * v_start +
            0.5 * T * s * r * r * (2.0 - 5.0 * s) * a_start;
  point.a = 60.0 / (T * T) * s * r * (1.0 - 2.0 * s) * way -
            12.0 / T * s * r * (3.0 - 5.0 * s) * v_start +
            r * (1.0 + s * (-8.0 + 10.0 * s)) * a_start;
  return point;
}

void BegunLine::turnTo(const Vector3& p_WTarget, double time) {
  const Point now = at(time);
  p_start = now.p;
  v_start = now.v;
  a_start = now.a;
  p_target = p_WTarget;
  startTime = time;
}

}  // namespace softgauss::live
