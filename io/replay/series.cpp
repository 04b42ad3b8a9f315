// SPDX-License-Identifier: Apache-2.0
#include "io/replay/series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace softgauss::io {
namespace {

/// Four entries become two: two pairs of minimum and maximum, or at first four samples.
constexpr std::size_t kMerged = 4;

}  // namespace

SeriesTable::SeriesTable(int columns, int mostEntries)
    : columns_(columns),
      most_(std::max<std::size_t>(static_cast<std::size_t>(mostEntries) / kMerged, 1) * kMerged) {}

void SeriesTable::add(double time, std::span<const double> values) {
  std::vector<float>& rows = width_ == 1 ? rows_ : openRows_;
  std::vector<double>& times = width_ == 1 ? times_ : openTimes_;
  times.push_back(time);
  const std::size_t first = rows.size();
  rows.resize(first + values.size());
  std::transform(values.begin(), values.end(), rows.begin() + static_cast<std::ptrdiff_t>(first),
                 [](double value) { return static_cast<float>(value); });
  if (width_ > 1 && times.size() == static_cast<std::size_t>(width_)) finish();
  if (times_.size() >= most_) coarsen();
}

void SeriesTable::finish() {
  if (openTimes_.empty()) return;
  appendBucket(openTimes_, openRows_);
  openTimes_.clear();
  openRows_.clear();
}

void SeriesTable::appendBucket(std::span<const double> times, std::span<const float> rows) {
  const auto n = static_cast<std::size_t>(columns_);
  times_.push_back(times.front());
  times_.push_back(times[times.size() / 2]);
  const std::size_t first = rows_.size();
  rows_.resize(first + 2 * n, std::numeric_limits<float>::quiet_NaN());
  float* least = rows_.data() + first;
  float* greatest = least + n;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // fmin and fmax pass over NaN.
    least[i % n] = std::fmin(least[i % n], rows[i]);
    greatest[i % n] = std::fmax(greatest[i % n], rows[i]);
  }
}

void SeriesTable::coarsen() {
  const std::vector<double> times = std::exchange(times_, {});
  const std::vector<float> rows = std::exchange(rows_, {});
  times_.reserve(most_ + 2);
  rows_.reserve((most_ + 2) * static_cast<std::size_t>(columns_));
  for (std::size_t i = 0; i < times.size(); i += kMerged) {
    const std::size_t count = std::min(kMerged, times.size() - i);
    const auto n = static_cast<std::size_t>(columns_);
    appendBucket(std::span(times).subspan(i, count), std::span(rows).subspan(i * n, count * n));
  }
  width_ *= width_ == 1 ? static_cast<int>(kMerged) : 2;
}

std::vector<float> SeriesTable::column(int c) const {
  std::vector<float> values(times_.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = rows_[i * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(c)];
  return values;
}

SeriesTable SeriesTable::thinned(int most) const {
  SeriesTable table = *this;
  while (table.size() > most) table.coarsen();
  return table;
}

}  // namespace softgauss::io
