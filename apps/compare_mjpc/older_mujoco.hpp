// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What MuJoCo MPC's utilities call and newer MuJoCo has otherwise: read before them, so that they
/// compile as they are. Its iLQG comes to neither.

#include <mujoco/mujoco.h>

#if mjVERSION_HEADER >= 3012001  // with which it was tried

#define mju_error_s mju_error

inline mjtNum mj_ray(const mjModel* model, const mjData* data, const mjtNum* point,
                     const mjtNum* direction, const mjtByte* groups, mjtByte fixedToo, int without,
                     int* geometry) {
  return mj_ray(model, data, point, direction, groups, fixedToo, without, geometry, nullptr);
}

#endif
