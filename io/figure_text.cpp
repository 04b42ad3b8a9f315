// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/figure_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace softgauss::io {

std::string lengthText(double metres) {
  constexpr double kShortestInMetres = 0.9995;  // 999.5 mm would be "1e+03 mm"
  constexpr double kLeast = 1e-6;
  if (std::abs(metres) < kLeast) return metres == 0.0 ? "0 mm" : "< 0.001 mm";
  if (std::abs(metres) < kShortestInMetres) return fmt::format("{:.3g} mm", 1e3 * metres);
  return fmt::format("{:.3g} m", metres);
}

std::string figureText(double value, const std::string& unit) {
  constexpr double kLeast = 1e-6;
  if (unit == "m") return lengthText(value);
  if (value != 0.0 && std::abs(value) < kLeast) return fmt::format("< {:g} {}", kLeast, unit);
  return fmt::format("{:.3g} {}", value, unit);
}

}  // namespace softgauss::io
