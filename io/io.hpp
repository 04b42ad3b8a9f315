// SPDX-License-Identifier: Apache-2.0
#pragma once

/// softgauss::io: robots in, logs and summaries out.

#include "softgauss/io/actuators.hpp"
#include "softgauss/io/explain.hpp"
#include "softgauss/io/goals.hpp"
#include "softgauss/io/inputs.hpp"
#include "softgauss/io/log.hpp"
#include "softgauss/io/mcap_log.hpp"
#include "softgauss/io/mesh.hpp"
#include "softgauss/io/mjcf.hpp"
#include "softgauss/io/names.hpp"
#include "softgauss/io/output.hpp"
#include "softgauss/io/printable.hpp"
#include "softgauss/io/scene.hpp"
#include "softgauss/io/summary.hpp"
#include "softgauss/io/torque_table.hpp"
#include "softgauss/io/urdf.hpp"
#include "softgauss/io/wrenches.hpp"
