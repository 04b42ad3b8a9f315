// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The processes of a sweep under mpirun. Rank 0 hands out runs, keeps their rows and works itself;
/// the others ask for runs and send rows. Built without MPI, or started without mpirun, there is
/// one process.
///
/// A rank that is lost costs at most the runs it had in hand: when nothing else is left, whoever is
/// idle gets those too, and the first row of a run counts. As a run is the same bits wherever it is
/// done, so is the table.

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "apps/simulate_batch/mpi_messages.hpp"
#include "apps/simulate_batch/run_table.hpp"

namespace softgauss::app {

/// Does runs and calls back with their rows, one at a time.
using DoRuns =
    std::function<void(const std::vector<long>& runs, const std::function<void(RunRow)>& done,
                       const std::atomic<bool>& stop)>;

class Ranks {
 public:
  /// Starts MPI where the process was started by an MPI launcher.
  Ranks(int& argc, char**& argv);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }

  /// Of rank 0: until all runs of the table are there, or `stop`. `added` is called after each row.
  void lead(RunTable& table, const DoRuns& doRuns, const std::function<void()>& added,
            std::atomic<bool>& stop, int threads);
  /// Of the others: until rank 0 has no more for them.
  void follow(const DoRuns& doRuns, std::atomic<bool>& stop, int threads);
  /// Ends all ranks at once, where one cannot go on.
  void abort(int code);

 private:
  /// The runs that rank 0 gives; none when it is over.
  std::vector<long> awaitRuns();

  int rank_ = 0, size_ = 1;
  bool started_ = false;
  bool lost_ = false;  ///< a rank has not answered, and none can wait for it
};

}  // namespace softgauss::app
