// SPDX-License-Identifier: Apache-2.0
#pragma once

/// <tendon>: a <fixed> one is a sum of joint positions that an actuator may pull.

#include "softgauss/io/mjcf/xml.hpp"

namespace softgauss::io::mjcf {

struct Tendon {
  Element element;
  std::string name;
  std::vector<std::pair<std::string, double>> joints;  ///< and coefficients

  /// `defaults`, elements <tendon> of its classes, outermost first. Throws where it makes a force
  /// of its own, or is spatial and does.
  void read(const Element& element, const std::vector<Element>& defaults);
};

}  // namespace softgauss::io::mjcf
