// SPDX-License-Identifier: Apache-2.0
#include "apps/simulate_batch/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string_view>

#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/yaml.hpp"
#include "softgauss/io/names.hpp"
#include "softgauss/io/simulation/named_options.hpp"

namespace softgauss::app {
namespace {

using io::detail::Range;
using io::detail::YamlMap;
using io::detail::YamlValue;

const std::vector<std::string> kAxes = {"x", "y", "z"};

/// As a shell reads it back.
std::string shellWord(const std::string& text) {
  const bool isPlain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("/._-+:,@%=").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (isPlain && !text.empty()) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

/// As an option takes it.
OptionValue valueOf(const YamlValue& value) {
  switch (value.kind) {
    case YamlValue::Kind::list: {
      std::vector<std::string> words;
      for (const YamlValue& item : value.items) words.push_back(item.text);
      return words;
    }
    case YamlValue::Kind::map: {
      std::map<std::string, double> numbers;
      for (const YamlValue::Pair& pair : value.pairs)
        numbers[pair.key.text] = pair.value.finiteNumber().value_or(kNaN);
      return numbers;
    }
    default:
      if (value.isPlain && (value.text == "true" || value.text == "false"))
        return value.text == "true";
      if (const std::optional<double> number = value.finiteNumber()) return *number;
      return value.text;
  }
}

/// A whole number from `least` on.
long wholeNumber(const YamlMap& map, const YamlMap::Entry& entry, double least) {
  const double x = map.number(entry);
  if (x < least || x > kMostRuns || x != std::floor(x))
    map.fail(entry, fmt::format("found {}, expected a whole number from {} to {:.0f}", x, least,
                                kMostRuns));
  return static_cast<long>(x);
}

/// {from: …, to: …, steps: …}
std::vector<double> evenly(const YamlMap& map) {
  map.expectOnly({"from", "to", "steps"});
  const double from = map.number(map.required("from", "a number"));
  const double to = map.number(map.required("to", "a number"));
  const long steps = wholeNumber(map, map.required("steps", "how many values"), 2);
  std::vector<double> values;
  for (long i = 0; i < steps; ++i)
    values.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(steps - 1));
  return values;
}

Draw readDraw(const YamlMap& map, const YamlMap::Entry& entry, Draw::Law law) {
  const std::vector<double> ab =
      map.numbers(entry, 2, 2, law == Draw::Law::normal ? "[mean, deviation]" : "[from, to]");
  if (law == Draw::Law::normal ? ab[1] < 0.0 : ab[1] < ab[0])
    map.fail(entry, law == Draw::Law::normal ? "expected a deviation of at least 0"
                                             : "expected the smaller one first");
  if (law == Draw::Law::logUniform && !(ab[0] > 0.0))
    map.fail(entry, fmt::format("found {}, expected numbers above 0", ab[0]));
  return {law, ab[0], ab[1]};
}

Sweep::Varied readVaried(const YamlMap& vary, const YamlMap::Entry& entry) {
  Sweep::Varied varied;
  varied.name = entry.key;
  varied.where = {vary.file(), entry.line};
  if (entry.value.kind == YamlValue::Kind::list) {
    varied.values = vary.numbers(entry, 1, static_cast<std::size_t>(kMostRuns), "a list of values");
    return varied;
  }
  const YamlMap map = vary.map(entry);
  const std::pair<const char*, Draw::Law> laws[] = {{"uniform", Draw::Law::uniform},
                                                    {"log_uniform", Draw::Law::logUniform},
                                                    {"normal", Draw::Law::normal}};
  for (const auto& [key, law] : laws)
    if (const auto* drawn = map.find(key)) {
      map.expectOnly({key});
      varied.draw = readDraw(map, *drawn, law);
      return varied;
    }
  if (map.find("from") || map.find("to") || map.find("steps")) {
    varied.values = evenly(map);
    return varied;
  }
  map.expectOnly({"from", "to", "steps", "uniform", "log_uniform", "normal"});
  vary.fail(entry,
            "found nothing, expected a list of values, {from, to, steps}, {uniform: [a, b]}, "
            "{log_uniform: [a, b]} or {normal: [mean, deviation]}");
}

/// The keys that say what runs.
class SweepReader {
 public:
  SweepReader(const YamlMap& top, Sweep& sweep) : top_(top), sweep_(sweep) {}

  void read() {
    std::vector<std::string> known = {"model", "goals", "reach",    "posture", "passive",
                                      "plan",  "mpc",   "duration", "seed",    "runs",
                                      "vary",  "list",  "measure"};
    for (const NamedOption& option : NamedOption::all()) known.emplace_back(option.name);
    top_.expectOnly(known);
    readModel();
    readGoals();
    for (const auto& [key, asked] :
         {std::pair{"plan", &sweep_.options.plan}, {"mpc", &sweep_.options.mpc}})
      if (const auto* entry = top_.find(key)) readPlanned(*entry, *asked);
    if (const auto* entry = top_.find("seed"))
      sweep_.seed = static_cast<std::uint64_t>(wholeNumber(top_, *entry, 0));
    if (const auto* entry = top_.find("runs")) sweep_.repeats = wholeNumber(top_, *entry, 1);
    if (const auto* entry = top_.find("list")) readList(*entry);
    if (const auto* entry = top_.find("vary")) readVary(*entry);
    if (const auto* entry = top_.find("measure")) readMeasures(*entry);
  }

 private:
  std::filesystem::path path(const YamlMap::Entry& entry) const {
    const std::filesystem::path name = top_.name(entry);
    return name.is_absolute() ? name : std::filesystem::path(top_.file()).parent_path() / name;
  }

  void readModel() {
    SimulateOptions& o = sweep_.options;
    o.model = path(top_.required("model", "a .urdf file or a .yaml scene"));
    top_.read("duration", o.duration, Range::positive);
    o.hasDuration = top_.find("duration") != nullptr;
    for (const NamedOption& option : NamedOption::all())
      if (const auto* entry = top_.find(option.name)) readOption(option, *entry);
  }

  void readOption(const NamedOption& option, const YamlMap::Entry& entry) {
    SimulateOptions& o = sweep_.options;
    if (option.ofUrdf && o.isScene())
      top_.fail(entry, "is for a URDF; a scene file says it itself");
    if (!option.set(valueOf(entry.value), o))
      top_.fail(entry,
                fmt::format("found {}, expected {}", entry.value.described(), option.expected));
    // As every other name of a file in the sweep.
    const auto ofTheSweep = [&](std::filesystem::path& path) {
      if (path.is_relative()) path = std::filesystem::path(top_.file()).parent_path() / path;
    };
    if (option.name == std::string("srdf") && o.srdf != "none") ofTheSweep(o.srdf);
    if (option.name == std::string("package_paths"))
      for (std::filesystem::path& folder : o.packagePaths) ofTheSweep(folder);
  }

  /// LINK: [x, y, z], or {target: [x, y, z], point: [x, y, z], weight: …}.
  static ReachArgument readReach(const YamlMap& map, const YamlMap::Entry& entry) {
    ReachArgument reach{entry.key, Vector3::Zero(), Vector3::Zero(), std::nullopt};
    if (entry.value.kind != YamlValue::Kind::map) {
      reach.p_WTarget = map.vector3(entry);
      return reach;
    }
    const YamlMap keys = map.map(entry);
    keys.expectOnly({"target", "point", "weight"});
    reach.p_WTarget = keys.vector3(keys.required("target", "three numbers [x, y, z]"));
    keys.read("point", reach.p_FP);
    if (const auto* weight = keys.find("weight"))
      reach.weight = keys.number(*weight, Range::notNegative);
    return reach;
  }

  void readGoals() {
    SimulateOptions& o = sweep_.options;
    if (const auto* entry = top_.find("goals")) o.goals = path(*entry);
    if (const auto* entry = top_.find("reach")) {
      const YamlMap map = top_.map(*entry);
      for (const YamlMap::Entry& reach : map.entries()) o.reach.push_back(readReach(map, reach));
    }
    if (const auto* entry = top_.find("posture"))
      o.posture = top_.number(*entry, Range::notNegative);
    if (const auto* entry = top_.find("passive")) {
      o.passive = top_.boolean(*entry);
      if (o.passive && o.hasGoals())
        top_.fail(*entry, "found true beside goals, expected one of them");
    }
    if (!o.isScene() && !o.passive && !o.hasGoals())
      top_.fail("goals", top_.line(),
                "is missing, expected goals, reach, posture or passive: true beside a URDF");
  }

  void readPlanned(const YamlMap::Entry& entry, bool& asked) {
    const SimulateOptions& o = sweep_.options;
    asked = top_.boolean(entry);
    if (!asked) return;
    if (o.plan && o.mpc) top_.fail(entry, "found true beside plan, expected one of them");
    if (o.passive || o.hasGoals()) top_.fail(entry, "the plan is the goal, expected no other");
    if (!o.isScene()) top_.fail(entry, "found a URDF, expected a scene with a key plan");
  }

  void readList(const YamlMap::Entry& entry) {
    if (top_.list(entry).empty())
      top_.fail(entry, "is empty, expected a list of {parameter: value, …}");
    for (const YamlValue& item : top_.list(entry)) {
      if (item.kind != YamlValue::Kind::map)
        throw ModelError({top_.file(), item.line}, "key 'list'",
                         fmt::format("found {}, expected a map {{…}}", item.described()));
      const YamlMap map(top_.file(), "", "list.", item);
      std::vector<double> row;
      for (const YamlMap::Entry& value : map.entries()) {
        const std::size_t place = row.size();
        if (sweep_.listed.empty())
          sweep_.varied.push_back({value.key, {top_.file(), value.line}, {0.0}, {}});
        else if (place >= sweep_.varied.size() || sweep_.varied[place].name != value.key)
          map.fail(value, "expected the keys of the first item, in their order");
        row.push_back(map.number(value));
      }
      if (row.size() != sweep_.varied.size() || row.empty())
        throw ModelError({top_.file(), item.line}, "key 'list'",
                         "expected the keys of the first item, in their order");
      sweep_.listed.push_back(std::move(row));
    }
  }

  void readVary(const YamlMap::Entry& entry) {
    const YamlMap vary = top_.map(entry);
    for (const YamlMap::Entry& one : vary.entries()) {
      Sweep::Varied varied = readVaried(vary, one);
      if (!sweep_.listed.empty() && !varied.values.empty())
        vary.fail(one,
                  "found values beside a list, expected what is drawn alone: uniform, "
                  "log_uniform, normal");
      for (const Sweep::Varied& other : sweep_.varied)
        if (other.name == varied.name) vary.fail(one, "is in the list already");
      sweep_.varied.push_back(std::move(varied));
    }
  }

  void readMeasures(const YamlMap::Entry& entry) {
    for (const YamlValue& item : top_.list(entry)) {
      const std::size_t dot = item.text.rfind('.');
      const std::string axis = dot == std::string::npos ? "" : item.text.substr(dot + 1);
      const auto place = std::find(kAxes.begin(), kAxes.end(), axis);
      if (place == kAxes.end())
        throw ModelError(
            {top_.file(), item.line}, "key 'measure'",
            fmt::format("found {}, expected a link and an axis, as in ball.z", item.described()));
      sweep_.measures.push_back({item.text,
                                 item.text.substr(0, dot),
                                 static_cast<int>(place - kAxes.begin()),
                                 {top_.file(), item.line}});
    }
  }

  const YamlMap& top_;
  Sweep& sweep_;
};

}  // namespace

std::string Sweep::repeatCommand(long run) const {
  return fmt::format("simulate_batch {} --only {} --view run_{}.html", shellWord(file.string()),
                     run, run);
}

Sweep readSweep(const std::filesystem::path& file) {
  const std::string expected = "a sweep: model, vary, …";
  const std::string text = io::detail::readInput(file.string(), expected);
  const YamlValue value = io::detail::parseYaml(file.string(), text, expected);
  if (value.kind != YamlValue::Kind::map)
    throw ModelError({file.string(), value.line}, "sweep",
                     fmt::format("found {}, expected keys: model, vary, …", value.described()));
  Sweep sweep;
  sweep.file = file;
  SweepReader(YamlMap(file.string(), "", "", value), sweep).read();
  return sweep;
}

}  // namespace softgauss::app
