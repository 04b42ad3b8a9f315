// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Steps that are held against what must be true of every step.

#include "softgauss/engine/engine.hpp"

namespace softgauss::fuzz {

/// All of a state, bit for bit.
std::string bytesOf(const State& state);

class Run {
 public:
  /// `contacts` may be null. Model and contacts must outlive this object.
  Run(const Model& model, const State& start, ContactSource* contacts);

  /// Takes so many steps, fewer where one is refused. A finding is a state that is not finite after
  /// a step that was taken, an orientation that is none, a time that does not go on, a step from or
  /// with what is not finite that is not refused, and a refusal that changes the state.
  SolveStatus steps(const Input& input, int count);

  const State& state() const { return state_; }
  const Data& data() const { return data_; }

 private:
  void expectTaken(const State& before) const;

  const Model& model_;
  State state_;
  ContactSource* contacts_;
  Data data_;
};

}  // namespace softgauss::fuzz
