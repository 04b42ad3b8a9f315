// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A Simulation as Python holds it.

#include <atomic>
#include <map>

#include "apps/python/made.hpp"
#include "apps/python/pushes.hpp"
#include "softgauss/io/simulation/simulation.hpp"

namespace softgauss::python {

/// Throws std::runtime_error "another thread uses this simulation, …" where one is at work. For who
/// keeps the interpreter's lock.
void expectIdle(const std::atomic<bool>& busy, const char* what);

/// One thread at a time, from here on until it goes. Throws std::runtime_error where another is at
/// work.
class Turn {
 public:
  Turn(std::atomic<bool>& busy, const char* what);
  ~Turn() { busy_.store(false, std::memory_order_release); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  std::atomic<bool>& busy_;
};

/// Raises KeyboardInterrupt, or what else a signal asks for. Takes the interpreter's lock.
void seeSignals();

class Held {
 public:
  explicit Held(Simulation loaded) : sim_(std::move(loaded)), goalsOfFile_(sim_.goals.size()) {}

  /// For who keeps the interpreter's lock. Throws std::runtime_error while another thread steps.
  Simulation& sim();
  /// n steps without the interpreter's lock. Throws StepError where one is refused.
  void step(long n);
  void run(double seconds);
  Pushes& pushes() { return pushes_; }
  /// Goals leave by these two alone.
  void clearGoals();
  void removeGoal(const gdd::Goal& goal);
  /// How often goals have left.
  unsigned long goalsLeft() const { return goalsLeft_; }
  /// Whether a goal has left since goalsLeft() was that: another may be in its place in memory.
  bool hasLeft(const gdd::Goal* goal, unsigned long since) const {
    const auto left = left_.find(goal);
    return left != left_.end() && since < left->second;
  }
  /// Whether its goals are those of its file.
  bool hasGoalsOfFile() { return goalsLeft_ == 0 && sim().goals.size() == goalsOfFile_; }

  template <class F>
  auto alone(F&& f) {
    const Turn turn(busy_, "this simulation");
    return f(sim_);
  }

 private:
  Simulation sim_;
  std::size_t goalsOfFile_;
  Pushes pushes_;
  unsigned long goalsLeft_ = 0;
  std::map<const gdd::Goal*, unsigned long> left_;  ///< when the last one of that place has
  std::atomic<bool> busy_ = false;
};

}  // namespace softgauss::python

SOFTGAUSS_MADE_ONLY(softgauss::python::Held)
