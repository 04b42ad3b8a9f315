// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a step is given and cannot use, beside numbers that are not finite: vectors of another size
/// than the model's, a wrench on no body, a quaternion that is none, limits that are none.

#include <cstdint>
#include <string>

#include "softgauss/engine/dynamics/tree_selection.hpp"

namespace softgauss {

enum class BadInputKind : std::uint8_t {
  none,
  q,                  ///< size of State::q
  v,                  ///< size of State::v
  a,                  ///< size of State::a, where it is set; of a in inverseDynamics()
  connectionForces,   ///< size of State::connectionForces, where it is not empty
  warmStart,          ///< size of a vector of State::warmstart; of the guess of forwardDynamics()
  tau,                ///< size of Input::tau
  sleep,              ///< size of a list of State::sleep, where they are not empty
  setPoint,           ///< size of Input::setPoint or Input::setPointRate
  controlled,         ///< size of Input::controlled
  wrench,             ///< the body of one of Input::wrenches
  quaternion,         ///< length of a quaternion in State::q
  controlLimitsSize,  ///< size of gdd::ControlLimits
  controlLimits       ///< bounds in gdd::ControlLimits that cross or are not numbers
};

/// With SolveStatus::badInput.
struct BadInput {
  BadInputKind kind = BadInputKind::none;
  int index = -1;      ///< of the wrench in its list; the body of the quaternion; the dof of bounds
  double found = 0.0;  ///< a size, a body, a length
  double expected = 0.0;  ///< the size, the number of bodies, the length 1

  explicit operator bool() const { return kind != BadInputKind::none; }
};

/// A quaternion is normalised before it is used, so that any length is of a rotation. One that is
/// longer or shorter than 1 by more than this factor, as (0, 0, 0, 0) is, was not meant as one.
constexpr double kQuaternionFactor = 10.0;

/// The first thing that does not fit the model; NaN and ∞ fit.
BadInput findBadInput(const Model& model, const Input& input) noexcept;
BadInput findBadInput(const Model& model, const Input& input, const State& state) noexcept;
/// The same, of quaternions those of `bodies` alone.
BadInput findBadInput(const Model& model, const Input& input, const State& state,
                      Segments bodies) noexcept;
/// Of the quaternions in q (nq) alone.
BadInput findBadQuaternion(const Model& model, const VectorX& q, Segments bodies) noexcept;
BadInput findBadQuaternion(const Model& model, const VectorX& q) noexcept;

/// Whether neither has a NaN or an infinity, of these trees.
bool isFinite(const Input& input, const State& state, const TreeSelection& trees) noexcept;
/// The first dof whose position, velocity or applied force is not finite, −1 if none is.
int firstBadDof(const Model& model, const Input& input, const State& state) noexcept;

/// "State::q: found 3 numbers, expected 19".
std::string describe(const Model& model, const BadInput& bad);

}  // namespace softgauss
