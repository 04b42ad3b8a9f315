// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Scenes that several families share.

#include <string>
#include <vector>

#include "tests/stability/trial.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {

/// Steps at which the contact families are asked [s].
inline constexpr double kSteps[] = {0.0005, 0.002, 0.005, 0.01, 0.02};
inline constexpr Cone kCones[] = {Cone::pyramidal, Cone::elliptic};

/// Adds a free body of one shape called `name`, with the inertia of that solid, at X_WB.
void addBody(ModelBuilder& builder, const std::string& name, const Shape& shape, double mass,
             const Transform& X_WB, double friction = 1.0);

/// Cubes of 0.2 m called box0, box1, … of these masses [kg], one on the other on the ground.
ModelBuilder tower(const std::vector<double>& masses);

/// Three links of 0.2 m and 1 kg, link0 to link2, level along x on hinges about y that the world
/// holds.
ModelBuilder levelArm();

/// Largest tilt of a link's z axis from the vertical [rad].
double tilt(Trial& trial, const std::string& link);

/// exp of something even between two logarithms.
double decades(Random& random, double low, double high);

/// How far connections and welds are off at most [m].
double widestTie(Trial& trial);

/// A builder with this step and cone.
inline ModelBuilder with(ModelBuilder builder, double timestep, Cone cone = Cone::pyramidal) {
  builder.options.timestep = timestep;
  builder.options.cone = cone;
  return builder;
}

}  // namespace softgauss::test
