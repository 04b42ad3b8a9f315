// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_batch/mpi_messages.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <sstream>

#if defined(SOFTGAUSS_WITH_MPI)
#define OMPI_SKIP_MPICXX 1  // their C++ bindings, which warn
#include <mpi.h>
#endif

namespace softgauss::app::mpi {

#if defined(SOFTGAUSS_WITH_MPI)

bool start(int& argc, char**& argv, int& rank, int& size) {
  // A process of its own would wait for MPI's daemon; only a launcher sets one of these.
  bool launched = false;
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK", "PMI_SIZE"})
    launched = launched || std::getenv(name);
  if (!launched) return false;
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);  // a rank that is lost
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return true;
}

void end() { MPI_Finalize(); }

void abort(int code) {
  MPI_Abort(MPI_COMM_WORLD, code);
  std::_Exit(code);
}

void send(int rank, Kind kind, const std::string& text) {
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, rank, static_cast<int>(kind),
           MPI_COMM_WORLD);
}

std::optional<Message> receive() {
  int there = 0, size = 0;
  MPI_Status status;
  if (MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status) != MPI_SUCCESS ||
      !there)
    return std::nullopt;
  MPI_Get_count(&status, MPI_CHAR, &size);
  Message message{status.MPI_SOURCE, static_cast<Kind>(status.MPI_TAG),
                  std::string(static_cast<std::size_t>(size), '\0')};
  if (MPI_Recv(message.text.data(), size, MPI_CHAR, status.MPI_SOURCE, status.MPI_TAG,
               MPI_COMM_WORLD, MPI_STATUS_IGNORE) != MPI_SUCCESS)
    return std::nullopt;
  return message;
}

#else

bool start(int&, char**&, int&, int&) { return false; }
void end() {}
void abort(int code) { std::_Exit(code); }
void send(int, Kind, const std::string&) {}
std::optional<Message> receive() { return std::nullopt; }

#endif

std::string textOf(const std::vector<long>& runs) {
  return fmt::format("{}", fmt::join(runs, " "));
}

std::vector<long> runsOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<long> runs;
  for (long run = 0; stream >> run;) runs.push_back(run);
  return runs;
}

std::string textOf(const RunRow& row) {
  return fmt::format("{} {} {}", row.run, row.seconds, row.text);
}

RunRow rowOf(const std::string& text) {
  const std::size_t first = text.find(' '), second = text.find(' ', first + 1);
  return {std::stol(text), std::stod(text.substr(first + 1)), text.substr(second + 1)};
}

}  // namespace softgauss::app::mpi
