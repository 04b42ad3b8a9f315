// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace softgauss {

/// Value, first and second derivative of a scalar function.
struct Jet {
  double value = 0.0;
  double slope = 0.0;
  double curvature = 0.0;

  Jet& operator+=(const Jet& o) {
    value += o.value, slope += o.slope, curvature += o.curvature;
    return *this;
  }
};

}  // namespace softgauss
