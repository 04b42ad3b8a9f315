// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What an MJCF file comes to in numbers, by MuJoCo and by this engine, in the same states.

#include <filesystem>
#include <string>
#include <vector>

#include "softgauss/engine/core/types.hpp"

namespace softgauss::app {

/// A state, and what follows from it.
struct MjcfState {
  VectorX q, v;
  MatrixX M;
  VectorX bias;     ///< gravity and Coriolis forces
  VectorX passive;  ///< of springs and dampers
  VectorX a;        ///< without contacts and actuators
};

struct MjcfNumbers {
  int nq = 0, nv = 0;
  double mass = 0.0;               ///< of all bodies, those fixed to the world too [kg]
  std::vector<double> bodyMasses;  ///< of those that move, each with what is fixed to it
  std::vector<MjcfState> states;
  /// Of each actuator: the joint forces (nv) at the least and the most that it can make. Not finite
  /// where it has no bound.
  std::vector<VectorX> least, most;
};

/// By this engine with MuJoCo's model, in the states of `given`, of which q and v are read. Throws
/// ModelError.
MjcfNumbers ownNumbers(const std::filesystem::path& file, const std::vector<MjcfState>& given);

/// Where two differ.
struct MjcfDifference {
  std::string what;   ///< "M"
  double size = 0.0;  ///< relative to the largest entry, or absolute where that is below 1
};
/// The largest of each quantity, in a fixed order. Sizes that do not fit are infinitely apart.
std::vector<MjcfDifference> differences(const MjcfNumbers& own, const MjcfNumbers& other);

}  // namespace softgauss::app
