// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Figures with their units, for people.

#include <string>

namespace softgauss::io {

/// "0.4 mm", "412 mm", "1.3 m": lengths from 1 m on in metres; below a micrometre "< 0.001 mm".
std::string lengthText(double metres);

/// A figure in its unit, below a millionth of it "< 1e-06 rad"; one in "m" is a length.
std::string figureText(double value, const std::string& unit);

}  // namespace softgauss::io
