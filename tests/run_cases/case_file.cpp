// SPDX-License-Identifier: Apache-2.0
#include "tests/run_cases/case_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/yaml.hpp"

namespace softgauss::cases {
namespace {

namespace fs = std::filesystem;
using io::detail::YamlMap;
using io::detail::YamlValue;

constexpr std::pair<const char*, Take> kTakes[] = {
    {"first", Take::first},       {"last", Take::last}, {"least", Take::least},
    {"greatest", Take::greatest}, {"size", Take::size}, {"span", Take::span}};

Take readTake(const YamlMap& map) {
  const YamlMap::Entry* entry = map.find("take");
  if (!entry) return Take::last;
  std::vector<std::string> names;
  for (const auto& [name, take] : kTakes) names.emplace_back(name);
  const std::string chosen = map.choice(*entry, names);
  return std::find_if(std::begin(kTakes), std::end(kTakes),
                      [&](const auto& take) { return take.first == chosen; })
      ->second;
}

/// The bounds of a number: at_least, at_most, or near with within.
void readBounds(const YamlMap& map, Expectation& e) {
  if (const auto* entry = map.find("at_least")) e.atLeast = map.number(*entry);
  if (const auto* entry = map.find("at_most")) e.atMost = map.number(*entry);
  if (const auto* entry = map.find("near")) {
    const double value = map.number(*entry);
    const double within = map.number(map.required("within", "how near"));
    e.atLeast = value - within;
    e.atMost = value + within;
  }
  if (!e.atLeast && !e.atMost) map.required("at_most", "a bound: at_least, at_most or near");
}

Expectation readExpectation(const YamlMap& map) {
  map.expectOnly(
      {"exit", "says", "says_not", "of", "take", "at_least", "at_most", "near", "within"});
  Expectation e;
  if (const auto* entry = map.find("exit")) {
    e.exitCode = map.integer(*entry, {0, 1, 2, 3});
    e.text = fmt::format("exit {}", *e.exitCode);
  } else if (const auto* says = map.find("says")) {
    e.says = map.name(*says);
    e.text = fmt::format("says '{}'", e.says);
  } else if (const auto* saysNot = map.find("says_not")) {
    e.saysNot = map.name(*saysNot);
    e.text = fmt::format("says no '{}'", e.saysNot);
  } else {
    e.of = map.name(map.required("of", "one of exit, says, says_not and of"));
    e.take = readTake(map);
    readBounds(map, e);
    const char* const name = std::find_if(std::begin(kTakes), std::end(kTakes), [&](const auto& t) {
                               return t.second == e.take;
                             })->first;
    e.text = e.of.starts_with("summary:") ? e.of : fmt::format("{} {}", name, e.of);
    if (e.atLeast) e.text += fmt::format(" >= {:g}", *e.atLeast);
    if (e.atMost) e.text += fmt::format(" <= {:g}", *e.atMost);
  }
  return e;
}

YamlMap mapOf(const fs::path& file, const std::string& label, const YamlValue& value) {
  if (value.kind != YamlValue::Kind::map)
    throw ModelError({file.string(), value.line}, label,
                     fmt::format("found {}, expected a map {{…}}", value.described()));
  return YamlMap(file.string(), label + ": ", "", value);
}

Case readCase(const fs::path& file, const fs::path& top) {
  const std::optional<std::string> text = io::detail::readFile(file.string());
  if (!text) throw ModelError({file.string(), 0}, "file", "cannot be read, expected a case");
  const YamlValue root = io::detail::parseYaml(file.string(), *text, "what: … and runs: […]");
  const YamlMap map = mapOf(file, "case", root);
  map.expectOnly({"what", "runs"});
  Case result;
  result.folder = file.parent_path();
  result.name = fs::relative(result.folder, top).string();
  result.what = map.name(map.required("what", "the law in a sentence"));
  for (const YamlValue& item : map.list(map.required("runs", "a list of runs"))) {
    const YamlMap run = mapOf(file, fmt::format("run {}", result.runs.size() + 1), item);
    run.expectOnly({"arguments", "expect"});
    Run& added = result.runs.emplace_back();
    for (const YamlValue& argument : run.list(run.required("arguments", "those of simulate_gdd")))
      added.arguments.push_back(argument.text);
    for (const YamlValue& expected : run.list(run.required("expect", "what must hold")))
      added.expectations.push_back(readExpectation(
          mapOf(file, fmt::format("expectation in line {}", expected.line), expected)));
  }
  return result;
}

}  // namespace

bool Run::readsLog() const {
  return std::any_of(expectations.begin(), expectations.end(), [](const Expectation& e) {
    return !e.of.empty() && !e.of.starts_with("summary:");
  });
}

bool Run::readsSummary() const {
  return std::any_of(expectations.begin(), expectations.end(),
                     [](const Expectation& e) { return e.of.starts_with("summary:"); });
}

std::vector<Case> readCases(const fs::path& folder) {
  std::vector<Case> cases;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().filename() == "case.yaml") cases.push_back(readCase(entry.path(), folder));
  std::sort(cases.begin(), cases.end(),
            [](const Case& a, const Case& b) { return a.name < b.name; });
  return cases;
}

}  // namespace softgauss::cases
