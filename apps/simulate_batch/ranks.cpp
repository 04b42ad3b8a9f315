// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_batch/ranks.hpp"

#include <chrono>
#include <cstdlib>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "apps/shared/wall_clock.hpp"
#include "apps/simulate_batch/hand_out.hpp"
#include "apps/simulate_batch/mpi_messages.hpp"

namespace softgauss::app {
namespace {

/// Shorter pauses wake the processes so often that runs take longer: by 12 % with 0.3 ms.
constexpr auto kPause = std::chrono::milliseconds(2);
/// For a rank to ask once more when all is done.
constexpr auto kPatience = std::chrono::seconds(10);

/// Runs in a thread of its own; errors come out of finish().
class Background {
 public:
  explicit Background(std::function<void()> work)
      : thread_([this, work = std::move(work)] {
          try {
            work();
          } catch (...) {
            error_ = std::current_exception();
          }
          over_ = true;
        }) {}
  ~Background() {
    if (thread_.joinable()) thread_.join();
  }
  bool isOver() const { return over_; }
  void finish() {
    thread_.join();
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::atomic<bool> over_ = false;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace

Ranks::Ranks(int& argc, char**& argv) { started_ = mpi::start(argc, argv, rank_, size_); }

Ranks::~Ranks() {
  if (!started_) return;
  if (lost_) std::_Exit(0);  // there is nobody to end it with
  mpi::end();
}

void Ranks::abort(int code) {
  if (started_ && size_ > 1) mpi::abort(code);
}

void Ranks::lead(RunTable& table, const DoRuns& doRuns, const std::function<void()>& added,
                 std::atomic<bool>& stop, int threads) {
  HandOut handOut(table);
  if (size_ == 1) {
    doRuns(
        table.missing(),
        [&](RunRow row) {
          handOut.add(std::move(row));
          added();
        },
        stop);
    return;
  }
  std::atomic<bool> enough = false;  // for this process's threads: the others were faster
  Background own([&] {
    while (!stop && !handOut.isDone()) {
      const std::vector<long> share = handOut.take(threads, threads * size_);
      if (share.empty()) break;
      doRuns(
          share, [&](RunRow row) { handOut.add(std::move(row)); }, enough);
    }
  });
  int told = 0;  // ranks that know that it is over
  Clock::time_point over = Clock::time_point::max();
  for (long seen = -1; told < size_ - 1;) {
    if (stop || handOut.isDone() || own.isOver()) {
      enough = true;
      if (over == Clock::time_point::max()) {
        over = Clock::now();
        for (int rank = 1; rank < size_; ++rank) mpi::send(rank, mpi::Kind::enough, "");
      }
      if (Clock::now() - over > kPatience) lost_ = true;
      if (lost_) break;
    }
    if (handOut.done() != seen) seen = handOut.done(), added();
    const std::optional<mpi::Message> message = mpi::receive();
    if (!message) {
      std::this_thread::sleep_for(kPause);
      continue;
    }
    if (message->kind == mpi::Kind::row) {
      handOut.add(mpi::rowOf(message->text));
      continue;
    }
    const bool isOver = stop || own.isOver() || handOut.isDone();
    const int theirs = std::atoi(message->text.c_str());
    const std::vector<long> share =
        isOver ? std::vector<long>{} : handOut.take(theirs, threads * size_);
    mpi::send(message->rank, mpi::Kind::runs, mpi::textOf(share));
    if (share.empty()) ++told;
  }
  own.finish();
  added();
  for (int rank = 1; rank < size_; ++rank) mpi::send(rank, mpi::Kind::end, lost_ ? "lost" : "");
}

std::vector<long> Ranks::awaitRuns() {
  while (true) {
    const std::optional<mpi::Message> message = mpi::receive();
    if (!message) {
      std::this_thread::sleep_for(kPause);
    } else if (message->kind == mpi::Kind::end) {
      lost_ = message->text == "lost";
      return {};
    } else if (message->kind == mpi::Kind::runs) {
      if (std::vector<long> runs = mpi::runsOf(message->text); !runs.empty()) return runs;
    }
  }
}

void Ranks::follow(const DoRuns& doRuns, std::atomic<bool>& stop, int threads) {
  std::atomic<bool> enough = false;  // interrupted, or the others were faster
  for (bool ended = false; !ended;) {
    mpi::send(0, mpi::Kind::ask, std::to_string(threads));
    const std::vector<long> runs = awaitRuns();
    if (runs.empty()) return;
    // Rows go out from this thread alone, as MPI wants it.
    std::mutex mutex;
    std::vector<RunRow> rows;
    Background work([&] {
      doRuns(
          runs,
          [&](RunRow row) {
            const std::lock_guard lock(mutex);
            rows.push_back(std::move(row));
          },
          enough);
    });
    for (bool over = false; !over;) {
      over = work.isOver();
      std::vector<RunRow> ready;
      {
        const std::lock_guard lock(mutex);
        ready.swap(rows);
      }
      for (const RunRow& row : ready) mpi::send(0, mpi::Kind::row, mpi::textOf(row));
      const std::optional<mpi::Message> message = mpi::receive();
      // Rank 0 may have given up on this one.
      if (message && message->kind == mpi::Kind::end) ended = lost_ = true;
      if (stop || message) enough = true;
      if (!over) std::this_thread::sleep_for(kPause);
    }
    work.finish();
  }
}

}  // namespace softgauss::app
