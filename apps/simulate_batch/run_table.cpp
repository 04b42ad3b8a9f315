// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_batch/run_table.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
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
  const auto fail = [&](const std::string& problem) {
    throw ModelError({checkpointName_, 0}, "checkpoint", problem);
  };
  // Of the process: another one that writes here would mix its lines with ours.
  const int file = open(checkpointName_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(file);
    fail("is in use by another simulate_batch; wait for it, or give another --out");
  }
  checkpoint_ = file >= 0 ? fdopen(file, "r+b") : nullptr;
  const std::string first = kFormat + origin + "\n";
  const std::string text = io::detail::readFile(checkpointName_).value_or("");
  const std::size_t head = text.find('\n');
  if (head != std::string::npos && text.substr(0, head + 1) != first)
    throw ModelError({checkpointName_, 1}, "checkpoint",
                     "is of another sweep, or its files have changed; remove it, or give another "
                     "--out");
  const std::size_t columns = fieldsOf(header_).size();
  const auto isWhole = [&](const RunRow& row) {
    const std::vector<std::string> fields = fieldsOf(row.text);
    return fields.size() == columns && fields.front() == std::to_string(row.run);
  };
  const std::size_t end = text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
  for (std::size_t at = head + 1; head != std::string::npos && at < end;) {
    const std::size_t stop = text.find('\n', at);
    if (auto row = rowOf(text.substr(at, stop - at), runs()); row && isWhole(*row))
      place(std::move(*row));
    at = stop + 1;
  }
  const bool opened =
      checkpoint_ && std::fseek(checkpoint_, static_cast<long>(end), SEEK_SET) == 0 &&
      ftruncate(fileno(checkpoint_), static_cast<off_t>(end)) == 0 &&
      (end > 0 || std::fputs(first.c_str(), checkpoint_) >= 0) && std::fflush(checkpoint_) == 0;
  if (!opened) fail(fmt::format("cannot be written: {}", std::strerror(errno)));
}

void RunTable::place(RunRow row) {
  RunRow& own = rows_.at(static_cast<std::size_t>(row.run));
  if (own.run < 0) own = std::move(row), ++done_;
}

void RunTable::add(RunRow row) {
  if (has(row.run)) return;
  if (checkpoint_) {
    const std::string line = lineOf(row);
    if (std::fwrite(line.data(), 1, line.size(), checkpoint_) != line.size() ||
        std::fflush(checkpoint_) != 0)
      throw std::runtime_error(
          fmt::format("{}: cannot be written: {}", checkpointName_, std::strerror(errno)));
  }
  place(std::move(row));
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
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i] == '"' && quoted && i + 1 < row.size() && row[i + 1] == '"')
      fields.back() += row[i++];
    else if (row[i] == '"')
      quoted = !quoted;
    else if (row[i] == ',' && !quoted)
      fields.emplace_back();
    else
      fields.back() += row[i];
  }
  return fields;
}

std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

}  // namespace softgauss::app
