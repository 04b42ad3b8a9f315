// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/replay/series.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace softgauss::io {
namespace {

void add(SeriesTable& table, double time, const std::vector<double>& values) {
  double* sample = table.add(time);
  for (const double value : values) *sample++ = value;
}

TEST(SeriesTable, KeepsEverySampleOfAShortRun) {
  SeriesTable table(2, 100);
  for (int i = 0; i < 99; ++i) add(table, 0.5 * i, {1.0 * i, -2.0 * i});
  table.finish();
  ASSERT_EQ(table.size(), 99);
  EXPECT_EQ(table.samplesPerBucket(), 1);
  for (int i = 0; i < 99; ++i) {
    EXPECT_EQ(table.times()[i], 0.5 * i);
    EXPECT_EQ(table.column(0)[i], 1.0 * i);
    EXPECT_EQ(table.column(1)[i], -2.0 * i);
  }
}

// However many samples: bounded, in order, from the start, and each bucket holds the extremes of
// its own samples, in the order in which they came.
TEST(SeriesTable, ManySamplesKeepTheExtremesOfEveryBucket) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (const int samples : {101, 102, 399, 400, 401, 1234, 5003}) {
    SeriesTable table(2, 100);
    std::vector<double> first, second;
    for (int i = 0; i < samples; ++i) {
      const std::vector<double> values = {normal(random), normal(random)};
      first.push_back(values[0]);
      second.push_back(values[1]);
      add(table, i, values);
    }
    table.finish();
    EXPECT_LE(table.size(), 102);
    EXPECT_TRUE(std::is_sorted(table.times().begin(), table.times().end()));
    EXPECT_EQ(table.times().front(), 0.0);
    const int width = table.samplesPerBucket();
    ASSERT_GT(width, 1);
    EXPECT_EQ(table.size(), 2 * ((samples + width - 1) / width));
    for (const auto& [column, all] : {std::pair{0, first}, std::pair{1, second}})
      for (int i = 0; i < table.size(); i += 2) {
        const auto begin = all.begin() + i / 2 * width;
        const auto end = all.begin() + std::min(samples, (i / 2 + 1) * width);
        const auto least = std::min_element(begin, end), greatest = std::max_element(begin, end);
        EXPECT_EQ(table.column(column)[i], *std::min(least, greatest));
        EXPECT_EQ(table.column(column)[i + 1], *std::max(least, greatest));
      }
  }
}

// No saw's teeth: what rises or falls steadily does so however far it is thinned.
TEST(SeriesTable, RampsStayMonotone) {
  SeriesTable table(2, 100);
  for (int i = 0; i < 5003; ++i) add(table, i, {0.1 * i, -0.1 * i});
  table.finish();
  for (const SeriesTable& kept : {table, table.thinned(20)}) {
    const std::vector<double> rises = kept.column(0), falls = kept.column(1);
    EXPECT_TRUE(std::is_sorted(rises.begin(), rises.end()));
    EXPECT_TRUE(std::is_sorted(falls.rbegin(), falls.rend()));
  }
}

TEST(SeriesTable, GapsStayGaps) {
  const double gap = std::numeric_limits<double>::quiet_NaN();
  SeriesTable table(1, 8);
  for (int i = 0; i < 64; ++i) add(table, i, {i < 32 ? gap : 1.0 * i});
  table.finish();
  EXPECT_TRUE(std::isnan(table.column(0).front()));
  EXPECT_EQ(table.column(0).back(), 63.0);
}

TEST(SeriesTable, ThinnedKeepsTheExtremes) {
  SeriesTable table(1, 1000);
  for (int i = 0; i < 800; ++i) add(table, i, {std::sin(0.1 * i)});
  table.finish();
  EXPECT_EQ(table.thinned(2000).size(), 800);
  const SeriesTable thinned = table.thinned(100);
  EXPECT_LE(thinned.size(), 100);
  const std::vector<double> all = table.column(0), kept = thinned.column(0);
  EXPECT_EQ(*std::max_element(all.begin(), all.end()), *std::max_element(kept.begin(), kept.end()));
  EXPECT_EQ(*std::min_element(all.begin(), all.end()), *std::min_element(kept.begin(), kept.end()));
}

}  // namespace
}  // namespace softgauss::io
