// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Events on their way from pages to the simulation: few, and never in its way.

#include <mutex>
#include <utility>
#include <vector>

#include "apps/live/event.hpp"

namespace softgauss::live {

/// Who sent an event, and the number that its answer repeats. Client 0 is nobody: the event follows
/// from the end of a page.
struct Sender {
  long client = 0, id = 0;
};

class Inbox {
 public:
  static constexpr std::size_t kMost = 256;

  /// False where it is full. Of several moves of one client in a row the newest alone is kept.
  bool put(const Sender& sender, Event event) {
    const std::lock_guard lock(mutex_);
    if (event.kind == EventKind::move && !waiting_.empty() &&
        waiting_.back().second.kind == EventKind::move &&
        waiting_.back().first.client == sender.client) {
      waiting_.back() = {sender, std::move(event)};
      return true;
    }
    if (waiting_.size() >= kMost) return false;
    waiting_.emplace_back(sender, std::move(event));
    return true;
  }

  /// The page that wrote is gone: what it holds by the mouse is let go, after all that it has sent.
  void letGo() {
    const std::lock_guard lock(mutex_);
    if (!waiting_.empty() && waiting_.back().first.client == 0) return;
    for (const EventKind kind : {EventKind::release, EventKind::letGo}) {
      waiting_.emplace_back(Sender{}, Event{});
      waiting_.back().second.kind = kind;
    }
  }

  /// All that wait, in their order.
  void take(std::vector<std::pair<Sender, Event>>& out) {
    out.clear();
    const std::lock_guard lock(mutex_);
    std::swap(out, waiting_);
  }

 private:
  std::mutex mutex_;
  std::vector<std::pair<Sender, Event>> waiting_;
};

}  // namespace softgauss::live
