// SPDX-License-Identifier: Apache-2.0
/// simulate_batch: many runs of a scene. Options and exit codes: simulate_batch --help and
/// docs/reference/batch.md.

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <thread>

#include "apps/shared/standard_streams.hpp"
#include "apps/simulate_batch/batch.hpp"

namespace softgauss::app {
namespace {

int runProgram(int argc, char** argv, Ranks& ranks) {
  // All ranks find the same mistake: the first tells it, and ends the others while they wait.
  const auto fail = [&](const std::string& message, ExitCode code) {
    if (ranks.rank() > 0) std::this_thread::sleep_for(std::chrono::seconds(1));
    tell(message);
    ranks.abort(code);
    return code;
  };
  try {
    const auto options = parseBatchCommandLine(argc, argv);
    return options ? runBatch(*options, ranks) : kDone;
  } catch (const UsageError& error) {
    return fail(
        fmt::format("simulate_batch: {}\nsimulate_batch --help lists the options", error.what()),
        kBadInput);
  } catch (const OutputError& error) {
    return fail(fmt::format("simulate_batch: {}", error.what()), kBadInput);
  } catch (const ModelError& error) {
    return fail(error.what(), kBadInput);
  } catch (const std::exception& error) {
    return fail(fmt::format("simulate_batch: {}", error.what()), kInternalError);
  }
}

}  // namespace
}  // namespace softgauss::app

int main(int argc, char** argv) {
  using namespace softgauss;
  app::prepareStreams();
  app::Ranks ranks(argc, argv);
  const int code = app::runProgram(argc, argv, ranks);
  const int output = app::finishStandardOutput("simulate_batch");
  return code != app::kDone ? code : output;
}
