// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The solvers of goal directed dynamics, for tests that hold each of them to the same laws.

#include <gtest/gtest.h>

#include "softgauss/gdd/active_set.hpp"
#include "softgauss/gdd/augmented_lagrangian.hpp"
#include "softgauss/gdd/goal_directed_step.hpp"

namespace softgauss::test {

using GddSolvers = testing::Types<gdd::AugmentedLagrangian, gdd::ActiveSet>;

inline constexpr gdd::GddSolver kSolvers[] = {gdd::GddSolver::activeSet,
                                              gdd::GddSolver::augmentedLagrangian};

}  // namespace softgauss::test
