// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_gdd/live_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "softgauss/gdd/goals/posture.hpp"

namespace softgauss::app {
namespace {

constexpr int kDefaultPort = 8080;

bool isNumber(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::vector<std::string> argumentsOf(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  for (std::size_t i = 0; i < arguments.size() && arguments[i] != "--"; ++i) {
    const bool hasPort = i + 1 < arguments.size() && isNumber(arguments[i + 1]);
    if (arguments[i] == "--live" && !hasPort) arguments[i] = fmt::format("--live={}", kDefaultPort);
  }
  return arguments;
}

void addLiveOptions(CLI::App& app, SimulateOptions& options) {
  const char* const live = "Live";
  app.add_option_function<int>(
         "--live",
         [&options](int port) {
           options.live = std::make_shared<LivePlace>();
           options.live->port = static_cast<unsigned short>(port);
         },
         "[PORT]: run in real time and serve a page on 127.0.0.1 that shows the run and in which\n"
         "links are dragged by the mouse, until interrupted or for --duration; default 8080,\n"
         "0: any port that is free")
      ->check(CLI::Range(0, 65535))
      ->type_name("")
      ->group(live);
  app.add_option("--live-address", options.liveAddress,
                 "another address to listen on; pages then need a token, which is printed")
      ->group(live);
  app.add_option("--record", options.record, "write the events of a live run to a .yaml file")
      ->group(live);
  app.add_option("--play", options.play,
                 "replay the events of such a file, bit for bit, without pages or waiting")
      ->group(live);
}

void finishLiveOptions(const CLI::App& app, SimulateOptions& options) {
  for (const char* option : {"--live-address", "--record"})
    if (app.count(option) > 0 && !options.live)
      throw UsageError(fmt::format("{} is for a live run, expected --live too", option));
  if (!options.acted()) return;
  if (options.live && !options.play.empty()) throw UsageError("choose one of --live and --play");
#ifndef SOFTGAUSS_WITH_LIVE
  if (options.live)
    throw UsageError("--live: this build has none, for Boost's headers were not found by CMake");
#endif
  if (app.count("--duration") == 0) options.duration = kInfinity;
  // A robot that nobody has told anything holds its posture, and gives way to who drags it.
  if (!options.isScene() && !options.passive && !options.servos && options.torques.empty() &&
      !options.hasGoals())
    options.posture = gdd::Posture::kDefaultWeight;
}

}  // namespace softgauss::app
