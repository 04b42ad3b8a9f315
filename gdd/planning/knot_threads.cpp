// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/planning/knot_threads.hpp"

namespace softgauss::planning {

KnotThreads::KnotThreads(const Model& model, const Contacts& contacts, int threads)
    : model_(model), makesContacts_(contacts) {
  if (threads < 1)
    throw ModelError({}, "plan", "threads are " + std::to_string(threads) + ", expected ≥ 1");
  for (int i = 0; i < threads; ++i) {
    contacts_.push_back(contactsFor(model));
    dynamics_.push_back(std::make_unique<PlanDynamics>(model, contacts_.back().get()));
  }
  for (std::size_t i = 1; i < dynamics_.size(); ++i) others_.emplace_back([this, i] { serve(i); });
}

KnotThreads::~KnotThreads() {
  job_ = {};
  ++round_;
  round_.notify_all();
  for (std::thread& thread : others_) thread.join();
}

void KnotThreads::restart() {
  for (std::size_t i = 0; i < dynamics_.size(); ++i) {
    contacts_[i] = contactsFor(model_);
    dynamics_[i]->restart(contacts_[i].get());
  }
}

bool KnotThreads::run(const Job& job) {
  refused_ = false;
  job_ = job;
  if (!others_.empty()) {
    busy_ = static_cast<int>(others_.size());
    ++round_;
    round_.notify_all();
  }
  work(0);
  for (int busy = busy_; busy > 0; busy = busy_) busy_.wait(busy);
  return !refused_;
}

/// The thread's range of the knots.
void KnotThreads::work(std::size_t thread) {
  const auto end = [&](std::size_t i) {
    return static_cast<int>(idx(job_.knots) * i / dynamics_.size());
  };
  for (int t = end(thread); t < end(thread + 1) && !refused_; ++t)
    if (!job_.call(job_.f, *dynamics_[thread], t)) refused_ = true;
}

void KnotThreads::serve(std::size_t thread) {
  for (int seen = 0;; ++seen) {
    round_.wait(seen);
    if (!job_.call) return;
    work(thread);
    if (--busy_ == 0) busy_.notify_one();
  }
}

}  // namespace softgauss::planning
