// SPDX-License-Identifier: Apache-2.0
#pragma once

/// softgauss::io: robots in, logs and summaries out.

#include "io/actuators.hpp"
#include "io/explain.hpp"
#include "io/goals.hpp"
#include "io/inputs.hpp"
#include "io/log.hpp"
#include "io/mesh.hpp"
#include "io/names.hpp"
#include "io/output.hpp"
#include "io/printable.hpp"
#include "io/scene.hpp"
#include "io/summary.hpp"
#include "io/torque_table.hpp"
#include "io/urdf.hpp"
#include "io/wrenches.hpp"
