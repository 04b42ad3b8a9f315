// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Who accompanies a run and acts on it between its steps: a person, or a file of what one did.

#include "apps/simulate_gdd/verdict.hpp"

namespace softgauss::app {

class Companion {
 public:
  virtual ~Companion() = default;
  /// What is to be told before the first step.
  virtual std::string announcement() const { return ""; }
  /// Between steps, `taken` of which lie behind; here events are applied. False ends the run.
  virtual bool before(long taken) = 0;
  /// The state is another than a step led to, as where somebody went back in time.
  virtual void moved() {}
  /// A step was taken; `verdict` has seen it.
  virtual void after(const SeenStep& step, const Verdict& verdict) = 0;
  /// What was told at once, as that a robot fell.
  virtual void tell(const std::string& message) = 0;
  /// The run has ended after so many steps. Throws std::runtime_error where a file could not be
  /// written.
  virtual void finish(long taken) = 0;
  /// Whether it ended the run for another one with the files as they are now.
  virtual bool reloads() const { return false; }
  /// What it has to say of the run in the end.
  virtual void conclude(io::Summary&) {}
};

}  // namespace softgauss::app
