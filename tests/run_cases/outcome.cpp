// SPDX-License-Identifier: Apache-2.0
#include "tests/run_cases/outcome.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>

#include "softgauss/io/detail/csv.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::cases {
namespace {

namespace fs = std::filesystem;
constexpr rlim_t kLongest = 300;  // [s] of processor time

[[noreturn]] void become(const fs::path& program, const Case& of,
                         std::vector<std::string> arguments, const fs::path& scratch) {
  const int null = open("/dev/null", O_RDONLY);
  const int out = open((scratch / "out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int err = open((scratch / "err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  dup2(null, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  const rlimit limit{kLongest, kLongest};
  setrlimit(RLIMIT_CPU, &limit);
  std::vector<char*> argv;
  arguments.insert(arguments.begin(), program.string());
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  if (chdir(of.folder.c_str()) == 0) execv(program.c_str(), argv.data());
  _exit(127);
}

std::string textOf(const fs::path& file) {
  return io::detail::readFile(file.string()).value_or(std::string());
}

/// Columns of a log. What the last row has no value of is left out of it: the states of a run are
/// one more than its steps.
std::map<std::string, std::vector<double>> columnsOf(const std::string& log) {
  std::map<std::string, std::vector<double>> columns;
  io::detail::CsvReader reader(log);
  const std::vector<std::string>* fields = reader.next();
  if (!fields) return columns;
  const std::vector<std::string> names = *fields;
  while ((fields = reader.next()))
    for (std::size_t i = 0; i < std::min(names.size(), fields->size()); ++i)
      if (const std::optional<double> x = io::detail::parseNumber((*fields)[i]))
        columns[names[i]].push_back(*x);
  const std::size_t states = columns["time_s"].size();
  for (auto& [name, values] : columns) {
    const bool isState = name == "time_s" || name.starts_with("q:") || name.starts_with("v:") ||
                         name.starts_with("energy");
    if (!isState && values.size() == states && states > 0) values.pop_back();
  }
  return columns;
}

double taken(Take take, const std::vector<double>& values) {
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  switch (take) {
    case Take::first:
      return values.front();
    case Take::last:
      return values.back();
    case Take::least:
      return *least;
    case Take::greatest:
      return *greatest;
    case Take::size:
      return std::max(std::abs(*least), std::abs(*greatest));
    case Take::span:
      return *greatest - *least;
  }
  return NAN;
}

/// The number at a path such as goals/0/final_error_m.
std::optional<double> summaryNumber(const std::string& summary, const std::string& path) {
  const nlohmann::json json = nlohmann::json::parse(summary, nullptr, false);
  const nlohmann::json::json_pointer at("/" + path);
  if (json.is_discarded() || !json.contains(at) || !json.at(at).is_number()) return std::nullopt;
  return json.at(at).get<double>();
}

}  // namespace

Outcome run(const fs::path& program, const Case& of, const Run& run, const fs::path& scratch) {
  fs::remove_all(scratch);
  fs::create_directories(scratch);
  std::vector<std::string> arguments = run.arguments;
  if (run.readsLog()) arguments.insert(arguments.end(), {"--log", scratch / "log.csv"});
  if (run.readsSummary())
    arguments.insert(arguments.end(), {"--summary", scratch / "summary.json"});
  const pid_t child = fork();
  if (child == 0) become(program, of, arguments, scratch);
  int status = 0;
  waitpid(child, &status, 0);
  Outcome outcome;
  outcome.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  outcome.said = textOf(scratch / "out") + textOf(scratch / "err");
  outcome.columns = columnsOf(textOf(scratch / "log.csv"));
  outcome.summary = textOf(scratch / "summary.json");
  return outcome;
}

std::string broken(const Expectation& e, const Outcome& outcome) {
  const auto said = [&] {
    const std::size_t end = std::min(outcome.said.find_last_not_of('\n') + 1, outcome.said.size());
    const std::string text = outcome.said.substr(0, end);
    return text.substr(text.find_last_of('\n') + 1);
  };
  if (e.exitCode)
    return *e.exitCode == outcome.exitCode ? std::string()
                                           : fmt::format("exit {}: {}", outcome.exitCode, said());
  if (!e.says.empty())
    return outcome.said.find(e.says) != std::string::npos ? "" : "it says: " + said();
  if (!e.saysNot.empty())
    return outcome.said.find(e.saysNot) == std::string::npos ? "" : "it says so";
  std::optional<double> found;
  if (e.of.starts_with("summary:")) {
    found = summaryNumber(outcome.summary, e.of.substr(std::string("summary:").size()));
  } else if (const auto column = outcome.columns.find(e.of);
             column != outcome.columns.end() && !column->second.empty()) {
    found = taken(e.take, column->second);
  }
  if (!found) return "there is no such number";
  const bool holds = *found >= e.atLeast.value_or(*found) && *found <= e.atMost.value_or(*found);
  return holds ? "" : fmt::format("{:.6g}", *found);
}

}  // namespace softgauss::cases
