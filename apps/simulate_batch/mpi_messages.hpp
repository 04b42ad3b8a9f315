// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The few calls of MPI that a sweep needs, all of them from one thread. Without MPI start() says
/// that there is one process, and the rest is never called.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/simulate_batch/run_table.hpp"

namespace softgauss::app::mpi {

enum class Kind : int {
  ask = 1,  ///< of rank 0, for runs
  runs,     ///< to do; none: it is over
  row,
  enough,  ///< what you do is done already
  end      ///< of all; with the text "lost" where a rank cannot take part in it
};

struct Message {
  int rank;
  Kind kind;
  std::string text;
};

/// Whether an MPI launcher has started this process; then MPI runs, with this rank of that many.
bool start(int& argc, char**& argv, int& rank, int& size);
void end();
[[noreturn]] void abort(int code);
void send(int rank, Kind kind, const std::string& text);
/// A message that has come; never waits.
std::optional<Message> receive();

std::string textOf(const std::vector<long>& runs);
std::vector<long> runsOf(const std::string& text);
std::string textOf(const RunRow& row);
RunRow rowOf(const std::string& text);

}  // namespace softgauss::app::mpi
