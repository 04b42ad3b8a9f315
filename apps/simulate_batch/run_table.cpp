// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_batch/run_table.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "softgauss/engine/core/check.hpp"
#include "softgauss/io/detail/output_file.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::app {
namespace {

constexpr const char* kFormat = "softgauss simulate_batch checkpoint 1 ";

/// A line of the checkpoint; nothing where it is none.
std::optional<RunRow> rowOf(const std::string& line, long runs) {
  const std::size_t first = line.find('\t'), second = line.find('\t', first + 1);
  if (first == std::string::npos || second == std::string::npos) return std::nullopt;
  const auto run = io::detail::parseNumber(line.substr(0, first));
  const auto seconds = io::detail::parseNumber(line.substr(first + 1, second - first - 1));
  if (!run || !seconds || *run < 0.0 || *run >= static_cast<double>(runs)) return std::nullopt;
  return RunRow{static_cast<long>(*run), *seconds, line.substr(second + 1)};
}

std::string lineOf(const RunRow& row) {
  std::string line = fmt::format("{}\t", row.run);
  io::detail::appendNumber(line, row.seconds);
  return line + "\t" + row.text + "\n";
}

}  // namespace

RunTable::RunTable(std::string header, long runs)
    : header_(std::move(header)), rows_(static_cast<std::size_t>(runs)) {}

RunTable::~RunTable() {
  if (checkpoint_) std::fclose(checkpoint_);
}

void RunTable::keepIn(const std::filesystem::path& checkpoint, const std::string& origin) {
  checkpointName_ = checkpoint.string();
  const std::string first = kFormat + origin + "\n";
  const std::string text = io::detail::readFile(checkpointName_).value_or("");
  const std::size_t head = text.find('\n');
  if (head != std::string::npos && text.substr(0, head + 1) != first)
    throw ModelError({checkpointName_, 1}, "checkpoint",
                     "is of another sweep, or its files have changed; remove it, or give another "
                     "--out");
  const std::size_t end = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
  for (std::size_t at = head + 1; head != std::string::npos && at < end;) {
    const std::size_t stop = text.find('\n', at);
    if (auto row = rowOf(text.substr(at, stop - at), runs())) add(std::move(*row));
    at = stop + 1;
  }
  checkpoint_ = std::fopen(checkpointName_.c_str(), end > 0 ? "r+b" : "wb");
  const bool opened =
      checkpoint_ && std::fseek(checkpoint_, static_cast<long>(end), SEEK_SET) == 0 &&
      ftruncate(fileno(checkpoint_), static_cast<off_t>(end)) == 0 &&
      (end > 0 || std::fputs(first.c_str(), checkpoint_) >= 0) && std::fflush(checkpoint_) == 0;
  if (!opened)
    throw ModelError({checkpointName_, 0}, "checkpoint",
                     fmt::format("cannot be written: {}", std::strerror(errno)));
}

void RunTable::add(RunRow row) {
  RunRow& place = rows_.at(static_cast<std::size_t>(row.run));
  if (place.run >= 0) return;
  if (checkpoint_) {
    const std::string line = lineOf(row);
    if (std::fwrite(line.data(), 1, line.size(), checkpoint_) != line.size() ||
        std::fflush(checkpoint_) != 0)
      throw std::runtime_error(
          fmt::format("{}: cannot be written: {}", checkpointName_, std::strerror(errno)));
  }
  place = std::move(row);
  ++done_;
}

std::vector<long> RunTable::missing() const {
  std::vector<long> runs;
  for (std::size_t i = 0; i < rows_.size(); ++i)
    if (rows_[i].run < 0) runs.push_back(static_cast<long>(i));
  return runs;
}

void RunTable::write(const std::filesystem::path& csv) const {
  io::detail::OutputFile file(csv, "runs.csv");
  file.write(header_ + "\n");
  for (const RunRow& row : rows_)
    if (row.run >= 0) file.write(row.text + "\n");
  file.commit();
}

std::vector<std::string> fieldsOf(const std::string& row) {
  std::vector<std::string> fields;
  for (std::size_t at = 0; at <= row.size();) {
    const bool quoted = at < row.size() && row[at] == '"';
    const std::size_t comma = quoted ? std::string::npos : row.find(',', at);
    if (comma == std::string::npos) {
      fields.push_back(quoted ? row.substr(at + 1, row.size() - at - 2) : row.substr(at));
      break;
    }
    fields.push_back(row.substr(at, comma - at));
    at = comma + 1;
  }
  return fields;
}

}  // namespace softgauss::app
