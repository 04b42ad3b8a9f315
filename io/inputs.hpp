// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Files that are read: how large they may be, and standard input in place of one.

#include <cstdint>

namespace softgauss::io {

/// A file of this name is standard input, which is read once.
inline constexpr const char* kStandardInput = "-";

/// Whether standard input holds XML, and so a URDF, not YAML. Reads it. Throws ModelError where it
/// cannot be read or is too large.
bool standardInputIsXml();

/// A text is refused that is larger [bytes]: URDF, scene, goals, tables. A larger one than the
/// default may take more than 10 s or 1 GB to be read or refused.
struct InputLimits {
  std::uintmax_t text = std::uintmax_t{64} << 20;
};

/// Of the process. To be changed before files are read.
InputLimits& inputLimits();

}  // namespace softgauss::io
