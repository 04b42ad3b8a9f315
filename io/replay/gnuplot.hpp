// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Drawings by gnuplot, a program of its own.

#include <string>

namespace softgauss::io {

/// Whether it is in the PATH.
bool hasGnuplot();
inline constexpr const char* kNoGnuplot =
    "gnuplot was not found, expected it in the PATH (Debian: apt-get install gnuplot-nox)";

/// The output that a script has to set.
inline constexpr const char* kGnuplotDrawing = "drawing.svg";

/// The drawing that gnuplot makes of a script. It gets plain names in a folder of its own, no
/// user's settings (-d) and no pipe, so neither names nor interrupts can confuse it. Throws
/// std::runtime_error when gnuplot fails or the disk is full.
std::string gnuplotDrawing(const std::string& script);

}  // namespace softgauss::io
