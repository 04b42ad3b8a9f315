// SPDX-License-Identifier: Apache-2.0
/// simulate_gdd: moves a URDF robot to its goals. Options and exit codes: simulate_gdd --help.

#include <fmt/format.h>

#include <exception>

#include "apps/simulate_gdd/accuracy.hpp"
#include "apps/simulate_gdd/run.hpp"

int main(int argc, char** argv) {
  using namespace softgauss;
  try {
    const auto options = app::parseCommandLine(argc, argv);
    if (!options) return app::kDone;
    const auto scene = app::loadScene(*options);
    if (options->explain) {
      fmt::print("{}", app::explainScene(*scene));
      return app::kDone;
    }
    if (options->accuracy) {
      const std::string choice = app::chooseAccuracy(*options, *scene);
      if (!options->quiet) fmt::print("{}\n", choice);
    }
    return app::run(*options, *scene);
  } catch (const app::UsageError& error) {
    fmt::print(stderr, "simulate_gdd: {}\nsimulate_gdd --help lists the options\n", error.what());
    return app::kBadInput;
  } catch (const app::OutputError& error) {
    fmt::print(stderr, "simulate_gdd: {}\n", error.what());
    return app::kBadInput;
  } catch (const app::AccuracyError& error) {
    fmt::print(stderr, "simulate_gdd: {}\n", error.what());
    return app::kBadInput;
  } catch (const ModelError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return app::kBadInput;
  } catch (const std::exception& error) {
    fmt::print(stderr, "simulate_gdd: internal error: {}\n", error.what());
    return app::kInternalError;
  }
}
