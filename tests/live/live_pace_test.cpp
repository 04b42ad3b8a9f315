// SPDX-License-Identifier: Apache-2.0
// What a live run owes to who looks at it, by the clock: frames, pace, latency; and that pages cost
// the simulation nothing. Each test prints what it has measured.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <thread>

#include "tests/io/temp_folder.hpp"
#include "tests/live/live_process.hpp"

namespace softgauss::test {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

const std::string kHumanoid = SOFTGAUSS_SOURCE_DIR "/data/robots/humanoid.urdf";

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A page that reads all it is sent until it is taken away, or the run ends.
class Reader {
 public:
  explicit Reader(unsigned short port) : page_(port), thread_([this] { read(); }) {}
  ~Reader() {
    stop_ = true;
    thread_.join();
  }

 private:
  void read() {
    try {
      while (!stop_) page_.next("status");
    } catch (const std::exception&) {
      // The run has ended.
    }
  }

  Client page_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

TEST(LivePaceLong, OffersSixtyFramesASecondInRealTime) {
  LiveProcess process({kHumanoid});
  Client page(process.port());
  const json first = page.until([](const json& s) { return s["time"] > 1.0; });
  const int framesBefore = page.frames();
  const Clock::time_point start = Clock::now();
  const double from = first["time"];
  const json last = page.until([&](const json& s) { return s["time"] > from + 8.0; }, 60.0);
  const double wall = secondsSince(start);
  const double rate = (page.frames() - framesBefore) / wall;
  const double factor = (last["time"].get<double>() - from) / wall;
  std::printf("frames offered: %.1f a second, real-time factor %.3f\n", rate, factor);
  EXPECT_GE(rate, 58.0) << "60, less what the two statuses are apart from the frames";
  EXPECT_LE(rate, 61.0);
  EXPECT_NEAR(factor, 1.0, 0.02);
  EXPECT_EQ(process.stop(), 130);
}

TEST(LivePaceLong, EventsAreInForceWithinFiftyMilliseconds) {
  LiveProcess process({kHumanoid});
  Client page(process.port());
  page.until([](const json& s) { return s["time"] > 0.5; });
  ASSERT_EQ(page.ask("\"grab\": {\"link\": \"right_hand\", \"point\": [0, 0, 0], \"target\": [0.2, "
                     "-0.3, 1.0]}"),
            "");
  // As often as a mouse moves where pictures are drawn; the answer comes once it is in force.
  std::vector<double> milliseconds;
  for (int i = 0; i < 600; ++i) {
    const double x = 0.2 + 0.05 * std::sin(0.05 * i);
    const Clock::time_point start = Clock::now();
    ASSERT_EQ(page.ask("\"move\": {\"target\": [" + std::to_string(x) + ", -0.3, 1.0]}"), "");
    milliseconds.push_back(1e3 * secondsSince(start));
    std::this_thread::sleep_for(std::chrono::milliseconds(16));
  }
  std::sort(milliseconds.begin(), milliseconds.end());
  const double p99 = milliseconds[milliseconds.size() * 99 / 100];
  std::printf("from the mouse to the goal: median %.1f ms, p99 %.1f ms\n",
              milliseconds[milliseconds.size() / 2], p99);
  EXPECT_LE(p99, 50.0);
  EXPECT_EQ(process.stop(), 130);
}

/// Median time of a step [µs] of a run of 4 s, with or without a page that reads.
double stepTime(bool watched) {
  const io::TempFolder folder;
  const std::string summary = folder.path() / "summary.json";
  LiveProcess process({kHumanoid, "--duration", "4", "--summary", summary, "--quiet"});
  {
    std::unique_ptr<Reader> reader;
    if (watched) reader = std::make_unique<Reader>(process.port());
    while (!std::filesystem::exists(summary))
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  EXPECT_EQ(process.stop(), 0);
  std::ifstream stream(summary);
  return json::parse(stream)["time_us"]["step"]["p50"];
}

TEST(LivePaceLong, StepsTakeAsLongAsWithoutAPage) {
  // In turn, and the least of each: what else runs on the machine only adds.
  double with = 1e9, without = 1e9;
  for (int i = 0; i < 6; ++i) {
    without = std::min(without, stepTime(false));
    with = std::min(with, stepTime(true));
  }
  std::printf("step: %.1f µs with a page, %.1f µs without, ratio %.3f\n", with, without,
              with / without);
  EXPECT_LE(with, 1.03 * without);
}

TEST(LivePaceLong, IsNotHeldUpByWhoStopsReading) {
  LiveProcess process({kHumanoid});
  Client stuck(process.port());
  stuck.next("status");
  Client page(process.port());
  const json first = page.until([](const json& s) { return s["time"] > 5.0; });
  const long memory = residentMemory(process.pid());
  const Clock::time_point start = Clock::now();
  const double from = first["time"];
  const json last = page.until([&](const json& s) { return s["time"] > from + 60.0; }, 120.0);
  const double factor = (last["time"].get<double>() - from) / secondsSince(start);
  const double grown = 1e-6 * static_cast<double>(residentMemory(process.pid()) - memory);
  std::printf("a minute beside who does not read: real-time factor %.3f, %.2f MB more\n", factor,
              grown);
  EXPECT_NEAR(factor, 1.0, 0.02);
  // Frames of a minute are 8 MB. What the run itself keeps for its summary is less than this.
  EXPECT_LT(grown, 3.0);
  // And the one who comes back sees what is now, after what was on its way.
  const json seen = stuck.until([&](const json& s) { return s["time"] >= last["time"]; }, 30.0);
  EXPECT_GT(seen["time"], from + 60.0);
  EXPECT_EQ(process.stop(), 130);
}

}  // namespace
}  // namespace softgauss::test
