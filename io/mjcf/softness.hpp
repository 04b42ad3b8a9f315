// SPDX-License-Identifier: Apache-2.0
#pragma once

/// solref and solimp of limits, friction, contacts and equalities.

#include "softgauss/engine/model/material.hpp"
#include "softgauss/io/mjcf/xml.hpp"

namespace softgauss::io::mjcf {

struct Softness {
  std::array<double, 2> solref{0.02, 1};
  std::array<double, 5> solimp{0.9, 0.95, 0.001, 0.5, 2};

  void read(const Element& element, const char* solrefName, const char* solimpName);
  Impedance impedance(const Element& element) const;
};

}  // namespace softgauss::io::mjcf
