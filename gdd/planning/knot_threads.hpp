// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The engine at the knots of a plan, over threads.
///
/// What a knot comes to is a function of its own state and acceleration, so that the bits are the
/// same for any number of threads. Each has engine, contacts and memory of its own, and takes a
/// range of the knots.

#include <atomic>
#include <functional>
#include <thread>
#include <vector>

#include "softgauss/gdd/planning/plan_dynamics.hpp"

namespace softgauss::planning {

class KnotThreads {
 public:
  using Contacts = std::function<std::unique_ptr<ContactSource>(const Model&)>;

  /// `contacts` makes what finds contacts (empty: nothing collides). The model must outlive this.
  /// Throws ModelError where threads < 1.
  KnotThreads(const Model& model, const Contacts& contacts, int threads);
  ~KnotThreads();
  KnotThreads(const KnotThreads&) = delete;

  /// The model's mechanisms or contacts have changed: what knows them is made anew.
  void restart();
  /// What finds contacts as plans do, of another model; null where nothing collides.
  std::unique_ptr<ContactSource> contactsFor(const Model& model) const {
    return makesContacts_ ? makesContacts_(model) : nullptr;
  }

  /// The engine of the calling thread.
  PlanDynamics& own() { return *dynamics_.front(); }

  /// f(dynamics, t) at the knots t < knots, in any order; false where it has said so of one. It
  /// must not throw.
  template <class F>
  bool atAll(int knots, const F& f) {
    return run({&f,
                [](const void* g, PlanDynamics& dynamics, int t) {
                  return (*static_cast<const F*>(g))(dynamics, t);
                },
                knots});
  }

 private:
  struct Job {
    const void* f = nullptr;
    bool (*call)(const void*, PlanDynamics&, int) = nullptr;
    int knots = 0;
  };

  bool run(const Job& job);
  void work(std::size_t thread);
  void serve(std::size_t thread);

  const Model& model_;
  Contacts makesContacts_;
  std::vector<std::unique_ptr<ContactSource>> contacts_;  ///< (threads)
  std::vector<std::unique_ptr<PlanDynamics>> dynamics_;   ///< (threads)
  Job job_;                                               ///< no call: the threads end
  std::atomic<int> round_ = 0;                            ///< jobs that have begun
  std::atomic<int> busy_ = 0;                             ///< threads at the present one
  std::atomic<bool> refused_ = false;
  std::vector<std::thread> others_;  ///< beside the calling one
};

}  // namespace softgauss::planning
