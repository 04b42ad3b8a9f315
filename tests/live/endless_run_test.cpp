// SPDX-License-Identifier: Apache-2.0
// What a run keeps that may go on for days, and what it keeps when it goes back.

#include <gtest/gtest.h>

#include <cmath>

#include "apps/live/rewind.hpp"
#include "apps/live/status.hpp"
#include "softgauss/io/replay/frames.hpp"
#include "softgauss/io/replay/series.hpp"
#include "softgauss/io/summary.hpp"
#include "softgauss/io/urdf.hpp"

namespace softgauss {
namespace {

TEST(EndlessRun, SeriesKeepABoundedShareAndTheMaximum) {
  io::Series series;
  constexpr long kCount = 3 * static_cast<long>(io::Series::kMost) + 12345;
  constexpr long kSpike =
      2 * static_cast<long>(io::Series::kMost) + 7;  // after samples are left out
  for (long i = 1; i <= kCount; ++i) series.add(i == kSpike ? 1e9 : static_cast<double>(i));
  EXPECT_LT(series.values.size(), io::Series::kMost);
  EXPECT_EQ(static_cast<long>(series.values.size()) + series.dropped, kCount);
  EXPECT_EQ(series.max(), 1e9);
  const double n = static_cast<double>(kCount);
  EXPECT_NEAR(series.mean(), (n * (n + 1) / 2 - kSpike + 1e9) / n, 1e-6 * n);
  // What is kept is evenly spaced.
  EXPECT_NEAR(series.percentile(0.5), 0.5 * n, static_cast<double>(series.every));
  EXPECT_NEAR(series.percentile(0.95), 0.95 * n, static_cast<double>(series.every));
}

TEST(EndlessRun, FramesAndSamplesAfterATimeAreForgotten) {
  io::FrameTrack frames(1, 0);
  io::SeriesTable series(1, 8);
  Snapshot snapshot;
  snapshot.X_WB.resize(1);
  snapshot.velocity.resize(1);
  snapshot.angularVelocity.resize(1);
  for (int i = 0; i < 40; ++i) {
    snapshot.time = 0.1 * i;
    frames.add(snapshot, {});
    series.add(snapshot.time)[0] = i;
  }
  frames.rewind(1.95);
  series.rewind(1.95);
  EXPECT_EQ(frames.count(), 20);
  EXPECT_EQ(frames.pose.size(), 140u);
  EXPECT_TRUE(frames.due(1.95));
  EXPECT_LT(series.times().back(), 1.95);
  const std::vector<double> column = series.column(0);
  ASSERT_EQ(column.size(), series.times().size());
  for (const double value : column) EXPECT_LT(value, 24.0);  // a bucket may end later
  frames.forget();
  EXPECT_EQ(frames.count(), 0);
  EXPECT_TRUE(frames.due(0.0));
}

TEST(EndlessRun, GoesBackToWhatItWas) {
  const Model model = io::readUrdf(SOFTGAUSS_SOURCE_DIR "/data/robots/arm.urdf", {}).build();
  State state(model);
  constexpr double h = 0.01;
  live::Rewind rewind(state, h);
  std::vector<std::uint64_t> hashes = {hash(state)};
  const auto stepTo = [&](long instant) {
    state.time = h * static_cast<double>(instant);
    state.q[0] = std::sin(state.time);
    rewind.observe(state, instant);
    hashes.resize(static_cast<std::size_t>(instant) + 1);
    hashes.back() = hash(state);
  };
  for (long i = 1; i <= 500; ++i) stepTo(i);
  live::Rewind::Place place = rewind.back(state, 1.0);
  EXPECT_EQ(place.instant, 400);
  EXPECT_EQ(hash(*place.state), hashes[400]);
  state = *place.state;
  place = rewind.back(state, 1.55);
  EXPECT_EQ(place.instant, 240) << "the newest that is at least as old";
  state = *place.state;
  place = rewind.back(state, 100.0);
  EXPECT_EQ(place.instant, 0);
  EXPECT_EQ(hash(*place.state), hashes[0]);
  // More than the ring holds: the oldest that is kept.
  state = *place.state;
  for (long i = 1; i <= 5000; ++i) stepTo(i);
  place = rewind.back(state, 1000.0);
  EXPECT_EQ(place.instant, 5000 - 10 * (live::Rewind::kMost - 1));
  EXPECT_EQ(rewind.reset().instant, 0);
}

TEST(EndlessRun, TimesOfStepsAreOfTheLastOnes) {
  live::StepTimes times(100);
  EXPECT_EQ(times.spread().most, 0.0);
  for (int i = 1; i <= 1000; ++i) times.add(i);
  EXPECT_EQ(times.spread().median, 950.0);
  EXPECT_EQ(times.spread().p99, 999.0);
  EXPECT_EQ(times.spread().most, 1000.0);
}

}  // namespace
}  // namespace softgauss
