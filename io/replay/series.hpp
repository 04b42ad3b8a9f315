// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Many quantities over one time axis, in bounded memory.
///
/// Short runs keep every sample. When the table is full, neighbouring samples become buckets, and a
/// bucket is kept as two entries: the least and the greatest value of each column, as an
/// oscilloscope does, in the order in which they came. So however long the run, a spike of one step
/// is still seen, and what falls steadily falls.

#include <span>
#include <vector>

namespace softgauss::io {

class SeriesTable {
 public:
  explicit SeriesTable(int columns, int mostEntries = 20000);

  /// Fetches the memory of so many samples now, so that adding them is cheap.
  void reserve(std::size_t samples);
  /// Appends a sample at `time` [s]: its values, one a column, are to be written where the returned
  /// pointer says, before the next call. NaN is a gap.
  double* add(double time);
  /// Ends the bucket that is open. To be called after the last sample.
  void finish();

  /// Forgets samples from `time` [s] on, a bucket at once where it began before: the run goes on
  /// from there.
  void rewind(double time);

  template <class Archive>
  void archive(Archive& a) {
    a(width_, times_, rows_, openTimes_, openRows_);
    if constexpr (Archive::kReads) a.expect(fits());
  }

  int size() const { return static_cast<int>(times_.size()); }  ///< entries
  int columns() const { return columns_; }
  const std::vector<double>& times() const { return times_; }
  std::vector<double> column(int c) const;
  /// Samples in a bucket; 1 while every sample is kept.
  int samplesPerBucket() const { return width_; }

  /// The same with at most `most` entries (a multiple of 4).
  SeriesTable thinned(int most) const;

 private:
  bool fits() const;  ///< what was read, together
  void makeRoom();
  void coarsen();
  void appendBucket(std::span<const double> times, std::span<const double> rows);

  int columns_;
  std::size_t most_;
  int width_ = 1;
  std::vector<double> times_;
  std::vector<double> rows_;  ///< entry by entry
  std::vector<double> openTimes_;
  std::vector<double> openRows_;  ///< samples of the bucket that is being filled
};

}  // namespace softgauss::io
