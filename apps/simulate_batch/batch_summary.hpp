// SPDX-License-Identifier: Apache-2.0
#pragma once

/// summary.json and the histograms of a sweep.

#include <string>
#include <vector>

#include "apps/simulate_batch/run_table.hpp"
#include "apps/simulate_batch/sweep.hpp"

namespace softgauss::app {

/// What only the program knows.
struct BatchTimes {
  double wallSeconds = 0.0;
  long doneBefore = 0;  ///< runs that a checkpoint had
  int threads = 1, ranks = 1;
  std::size_t bytesPerRun = 0, bytesPerThread = 0;
  double timestep = 0.002;
  std::string outcome = "completed";  ///< or "interrupted"
};

/// One column of the figures over the runs that were completed.
struct Column {
  std::string name;
  std::vector<double> values;  ///< finite, ascending
  double percentile(double share) const;
  double mean() const;
  double deviation() const;
};

/// The figures, behind the parameters.
std::vector<Column> figureColumns(const RunTable& table, std::size_t parameters);

std::string summaryJson(const Sweep& sweep, const RunTable& table, std::size_t parameters,
                        const BatchTimes& times);
/// The same for people, in a few lines.
std::string summaryText(const Sweep& sweep, const RunTable& table, const BatchTimes& times);
/// A script for gnuplot: a histogram a figure that is not the same in all runs; empty where there
/// is none.
std::string histogramScript(const std::vector<Column>& columns);

}  // namespace softgauss::app
