// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/replay/series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "softgauss/io/replay/detail/fetch.hpp"

namespace softgauss::io {

using detail::fetch;

namespace {

/// Four entries become two: two pairs of extremes, or at first four samples.
constexpr std::size_t kMerged = 4;

constexpr double kGap = std::numeric_limits<double>::quiet_NaN();

}  // namespace

SeriesTable::SeriesTable(int columns, int mostEntries)
    : columns_(columns),
      most_(std::max<std::size_t>(static_cast<std::size_t>(mostEntries) / kMerged, 1) * kMerged) {}

void SeriesTable::reserve(std::size_t samples) {
  const std::size_t entries = std::min(samples, most_) + 2;
  fetch(times_, entries);
  fetch(rows_, entries * static_cast<std::size_t>(columns_));
}

double* SeriesTable::add(double time) {
  makeRoom();
  std::vector<double>& rows = width_ == 1 ? rows_ : openRows_;
  (width_ == 1 ? times_ : openTimes_).push_back(time);
  const std::size_t first = rows.size();
  rows.resize(first + static_cast<std::size_t>(columns_));
  return rows.data() + first;
}

/// Closes the bucket or the table that the last sample has filled.
void SeriesTable::makeRoom() {
  if (width_ > 1 && openTimes_.size() == static_cast<std::size_t>(width_)) finish();
  if (times_.size() >= most_) coarsen();
}

void SeriesTable::finish() {
  if (openTimes_.empty()) return;
  appendBucket(openTimes_, openRows_);
  openTimes_.clear();
  openRows_.clear();
}

void SeriesTable::appendBucket(std::span<const double> times, std::span<const double> rows) {
  const auto n = static_cast<std::size_t>(columns_);
  times_.push_back(times.front());
  times_.push_back(times[times.size() / 2]);
  const std::size_t first = rows_.size();
  rows_.resize(first + 2 * n);
  for (std::size_t column = 0; column < n; ++column) {
    double least = kGap, greatest = kGap;
    bool falls = false;  // the greatest value comes before the least
    for (std::size_t i = column; i < rows.size(); i += n) {
      const double value = rows[i];
      if (std::isnan(value)) continue;
      // Also true while they are NaN.
      if (!(least <= value)) least = value, falls = true;
      if (!(greatest >= value)) greatest = value, falls = false;
    }
    rows_[first + column] = falls ? greatest : least;
    rows_[first + n + column] = falls ? least : greatest;
  }
}

void SeriesTable::coarsen() {
  const std::vector<double> times = std::exchange(times_, {});
  const std::vector<double> rows = std::exchange(rows_, {});
  times_.reserve(most_ + 2);
  rows_.reserve((most_ + 2) * static_cast<std::size_t>(columns_));
  for (std::size_t i = 0; i < times.size(); i += kMerged) {
    const std::size_t count = std::min(kMerged, times.size() - i);
    const auto n = static_cast<std::size_t>(columns_);
    appendBucket(std::span(times).subspan(i, count), std::span(rows).subspan(i * n, count * n));
  }
  width_ *= width_ == 1 ? static_cast<int>(kMerged) : 2;
}

bool SeriesTable::fits() const {
  const auto n = static_cast<std::size_t>(columns_);
  return width_ >= 1 && times_.size() <= most_ + 2 && rows_.size() == n * times_.size() &&
         openTimes_.size() <= static_cast<std::size_t>(width_) &&
         openRows_.size() == n * openTimes_.size();
}

void SeriesTable::rewind(double time) {
  const auto n = static_cast<std::size_t>(columns_);
  const auto cut = [&](std::vector<double>& times, std::vector<double>& rows) {
    const auto kept = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time) -
                                               times.begin());
    times.resize(kept);
    rows.resize(kept * n);
  };
  cut(openTimes_, openRows_);
  cut(times_, rows_);
  // Entries of buckets come in pairs.
  if (width_ > 1 && times_.size() % 2 == 1) {
    times_.pop_back();
    rows_.resize(times_.size() * n);
  }
}

std::vector<double> SeriesTable::column(int c) const {
  std::vector<double> values(times_.size());
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
