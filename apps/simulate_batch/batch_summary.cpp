// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_batch/batch_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/nearest_rank.hpp"
#include "softgauss/io/replay/gnuplot.hpp"

namespace softgauss::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostFailures = 100;
constexpr int kBars = 40;

/// Where columns of a row are.
struct Places {
  std::size_t outcome, time, figures;
};

Places placesOf(std::size_t parameters) { return {2 + parameters, 3 + parameters, 4 + parameters}; }

struct Counts {
  long completed = 0, failed = 0;
  double simulated = 0.0, cpu = 0.0;
  std::vector<long> failures;
};

Counts count(const RunTable& table, std::size_t parameters) {
  Counts counts;
  const Places at = placesOf(parameters);
  for (const RunRow& row : table.rows()) {
    if (row.run < 0) continue;
    const std::vector<std::string> fields = fieldsOf(row.text);
    const bool failed = fields.at(at.outcome) == "failed";
    (failed ? counts.failed : counts.completed) += 1;
    if (failed) counts.failures.push_back(row.run);
    counts.simulated += io::detail::parseNumber(fields.at(at.time)).value_or(0.0);
    counts.cpu += row.seconds;
  }
  return counts;
}

}  // namespace

double Column::percentile(double share) const {
  return values[io::nearestRank(share, values.size())];
}

double Column::mean() const {
  double sum = 0.0;
  for (const double x : values) sum += x;
  return sum / static_cast<double>(values.size());
}

double Column::deviation() const {
  const double m = mean();
  double sum = 0.0;
  for (const double x : values) sum += (x - m) * (x - m);
  return values.size() < 2 ? 0.0 : std::sqrt(sum / static_cast<double>(values.size() - 1));
}

std::vector<Column> figureColumns(const RunTable& table, std::size_t parameters) {
  const std::vector<std::string> names = fieldsOf(table.header());
  std::vector<Column> columns;
  for (std::size_t i = placesOf(parameters).figures; i + 1 < names.size(); ++i)
    columns.push_back({names[i], {}});
  for (const RunRow& row : table.rows()) {
    if (row.run < 0) continue;
    const std::vector<std::string> fields = fieldsOf(row.text);
    for (std::size_t c = 0; c < columns.size(); ++c)
      if (const auto x = io::detail::parseNumber(fields.at(placesOf(parameters).figures + c)))
        columns[c].values.push_back(*x);
  }
  for (Column& column : columns) std::sort(column.values.begin(), column.values.end());
  return columns;
}

std::string summaryJson(const Sweep& sweep, const RunTable& table, std::size_t parameters,
                        const BatchTimes& times) {
  const Counts counts = count(table, parameters);
  const double steps = counts.simulated / times.timestep;
  Json json;
  json["format"] = 1;
  json["version"] = SOFTGAUSS_VERSION;
  json["sweep"] = sweep.file.string();
  json["outcome"] = times.outcome;
  json["runs"] = table.runs();
  json["completed"] = counts.completed;
  json["failed"] = counts.failed;
  json["from_checkpoint"] = times.doneBefore;
  json["simulated_s"] = counts.simulated;
  json["threads"] = times.threads;
  json["ranks"] = times.ranks;
  json["wall_s"] = times.wallSeconds;
  json["cpu_s"] = counts.cpu;
  json["runs_per_s"] =
      static_cast<double>(table.done() - times.doneBefore) / std::max(times.wallSeconds, 1e-9);
  json["steps_per_s_and_core"] = steps / std::max(counts.cpu, 1e-9);
  json["bytes_per_run"] = times.bytesPerRun;
  json["bytes_per_thread"] = times.bytesPerThread;
  Json& figures = json["figures"] = Json::object();
  for (const Column& column : figureColumns(table, parameters)) {
    if (column.values.empty()) continue;
    figures[column.name] = {{"runs", column.values.size()},    {"mean", column.mean()},
                            {"deviation", column.deviation()}, {"min", column.values.front()},
                            {"p5", column.percentile(0.05)},   {"p50", column.percentile(0.5)},
                            {"p95", column.percentile(0.95)},  {"max", column.values.back()}};
  }
  Json& failures = json["failures"] = Json::array();
  for (const long run : counts.failures) {
    if (failures.size() == kMostFailures) break;
    const auto fields = fieldsOf(table.rows()[static_cast<std::size_t>(run)].text);
    failures.push_back({{"run", run},
                        {"seed", fields.at(1)},
                        {"reason", fields.back()},
                        {"command", sweep.repeatCommand(run)}});
  }
  return json.dump(2) + "\n";
}

std::string summaryText(const Sweep& sweep, const RunTable& table, const BatchTimes& times) {
  const Counts counts = count(table, sweep.varied.size());
  std::string text =
      fmt::format("{} of {} runs completed, {} failed, in {:.3g} s on {} threads{}\n",
                  counts.completed, table.runs(), counts.failed, times.wallSeconds, times.threads,
                  times.ranks > 1 ? fmt::format(" of {} ranks", times.ranks) : "");
  if (counts.cpu > 0.0)
    text += fmt::format("{:.0f} steps a second and core; {} bytes a run, {} bytes a thread\n",
                        counts.simulated / times.timestep / counts.cpu, times.bytesPerRun,
                        times.bytesPerThread);
  for (const Column& column : figureColumns(table, sweep.varied.size()))
    if (!column.values.empty())
      text += fmt::format("  {:<36} p5 {:<12.4g} p50 {:<12.4g} p95 {:.4g}\n", column.name,
                          column.percentile(0.05), column.percentile(0.5), column.percentile(0.95));
  for (std::size_t i = 0; i < std::min<std::size_t>(3, counts.failures.size()); ++i) {
    const long run = counts.failures[i];
    text += fmt::format("  run {}: {}\n    {}\n", run,
                        fieldsOf(table.rows()[static_cast<std::size_t>(run)].text).back(),
                        sweep.repeatCommand(run));
  }
  return text;
}

std::string histogramScript(const std::vector<Column>& columns) {
  std::string plots;
  int count = 0;
  for (const Column& column : columns) {
    if (column.values.empty() || !(column.values.back() > column.values.front())) continue;
    const double low = column.values.front(), width = (column.values.back() - low) / kBars;
    std::vector<long> bars(kBars, 0);
    for (const double x : column.values)
      ++bars[static_cast<std::size_t>(
          std::clamp(static_cast<int>((x - low) / width), 0, kBars - 1))];
    std::string title = column.name;
    std::replace(title.begin(), title.end(), '\'', ' ');
    plots += fmt::format("set xlabel '{}'\nplot '-' with boxes\n", title);
    for (int b = 0; b < kBars; ++b)
      plots += fmt::format("{} {}\n", low + (b + 0.5) * width, bars[static_cast<std::size_t>(b)]);
    plots += "e\n";
    ++count;
  }
  if (count == 0) return {};
  const int rows = (count + 1) / 2;
  return fmt::format(
             "set terminal svg size 900,{} noenhanced background 'white'\nset output '{}'\n"
             "set multiplot layout {},2\nset style fill solid 0.6\nset key off\n"
             "set ylabel 'runs'\nset yrange [0:*]\nset boxwidth 1 relative\n",
             260 * rows, io::kGnuplotDrawing, rows) +
         plots + "unset multiplot\n";
}

}  // namespace softgauss::app
