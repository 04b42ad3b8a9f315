// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The numbers of a goal that may change while a run goes on, whatever its kind.

#include "softgauss/gdd/goal.hpp"

namespace softgauss::live {

/// Where a goal keeps them; null what its kind does not have.
struct GoalSettings {
  double* weight = nullptr;
  const char* weightUnit = "";
  bool weightIsDefault = false;  ///< nobody has given it
  double* stiffness = nullptr;   ///< [1/s²]
  double* damping = nullptr;     ///< [1/s]
  double* rate = nullptr;        ///< [1/s]
};

GoalSettings settingsOf(gdd::Goal& goal);

}  // namespace softgauss::live
