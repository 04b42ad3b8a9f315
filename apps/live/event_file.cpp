// SPDX-License-Identifier: Apache-2.0
#include "apps/live/event_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "softgauss/io/detail/input_file.hpp"
#include "softgauss/io/detail/text.hpp"
#include "softgauss/io/detail/yaml.hpp"

namespace softgauss::live {
namespace {

using io::detail::YamlMap;
using io::detail::YamlValue;

constexpr double kMostSteps = 1e15;

FieldValue readField(const YamlMap& map, const YamlMap::Entry& entry, const Field& field) {
  switch (field.kind) {
    case FieldKind::number:
      return map.number(entry);
    case FieldKind::boolean:
      return map.boolean(entry);
    case FieldKind::vector:
      return map.vector3(entry);
    default:
      return map.name(entry);
  }
}

Event readEvent(const YamlMap& item, const YamlMap::Entry& only, const EventType& type,
                const Names& names) {
  Event event;
  event.kind = type.kind;
  if (type.fields.empty() && only.value.kind == YamlValue::Kind::nothing) return event;
  const YamlMap map = item.map(only);
  std::vector<std::string> known;
  for (const Field& field : type.fields) known.emplace_back(field.name);
  map.expectOnly(known);
  for (const Field& field : type.fields) {
    const YamlMap::Entry* entry =
        field.required ? &map.required(field.name, expectedOf(field)) : map.find(field.name);
    if (!entry) continue;
    const FieldValue value = readField(map, *entry, field);
    if (const std::string problem = problemOf(field, value); !problem.empty())
      map.fail(*entry, problem);
    if (const auto* text = std::get_if<std::string>(&value))
      if (const std::string problem = names.problem(field.kind, *text); !problem.empty())
        map.fail(*entry, problem);
    event.fields.emplace_back(field.name, value);
  }
  if (const std::string problem = problemOf(event, names); !problem.empty())
    item.fail(only, problem);
  return event;
}

long readStep(const YamlMap& map, const YamlMap::Entry& entry, long least) {
  const double step = map.number(entry, io::detail::Range::notNegative);
  if (step != std::floor(step) || step > kMostSteps)
    map.fail(entry, fmt::format("found {:g}, expected a number of whole steps", step));
  if (step < static_cast<double>(least))
    map.fail(entry,
             fmt::format("found {:g}, expected {} or more, as what is above it has", step, least));
  return static_cast<long>(step);
}

Event readItem(const std::string& file, const YamlValue& value, std::size_t number, long least,
               const Names& names) {
  const std::string label = fmt::format("event {}", number);
  if (value.kind != YamlValue::Kind::map)
    throw ModelError({file, value.line}, label,
                     fmt::format("found {}, expected {{step: …, kind: {{…}}}}", value.described()));
  const YamlMap item(file, label + ": ", "", value);
  std::vector<std::string> kinds = {"step"};
  for (const EventType& type : eventTypes()) kinds.emplace_back(type.name);
  item.expectOnly(kinds);
  const long step = readStep(item, item.required("step", "the steps before it"), least);
  if (item.entries().size() != 2)
    item.fail("step", item.line(),
              fmt::format("found {} beside it, expected one, the kind: {}",
                          io::detail::counted(item.entries().size() - 1, "key"),
                          io::detail::listed({kinds.begin() + 1, kinds.end()}, 20)));
  for (const YamlMap::Entry& entry : item.entries()) {
    const EventType* type = findEventType(entry.key);
    if (!type) continue;
    Event event = readEvent(item, entry, *type, names);
    event.step = step;
    return event;
  }
  return {};
}

std::string text(const FieldValue& value) {
  if (const auto* name = std::get_if<std::string>(&value)) {
    std::string quoted = "'";
    for (const char c : *name) quoted += c == '\'' ? std::string("''") : std::string(1, c);
    return quoted + "'";
  }
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  std::string out;
  if (const auto* x = std::get_if<double>(&value)) {
    io::detail::appendNumber(out, *x);
    return out;
  }
  const Vector3& v = std::get<Vector3>(value);
  for (int i = 0; i < 3; ++i) {
    out += i == 0 ? "[" : ", ";
    io::detail::appendNumber(out, v[i]);
  }
  return out + "]";
}

}  // namespace

EventFile readEvents(const std::filesystem::path& file, const Names& names, double timestep) {
  const std::string path = file.string();
  const std::string expected = "steps: … and events: [{step: …, kind: {…}}, …]";
  const YamlValue root =
      io::detail::parseYaml(path, io::detail::readInput(path, "a YAML file of events"), expected);
  if (root.kind != YamlValue::Kind::map)
    throw ModelError({path, root.line}, "events",
                     fmt::format("found {}, expected {}", root.described(), expected));
  const YamlMap map(path, "", "", root);
  map.expectOnly({"model", "timestep", "steps", "events"});
  if (const YamlMap::Entry* model = map.find("model"))
    if (const std::string name = map.name(*model); name != names.modelName)
      map.fail(*model, fmt::format("found {}, but this run is of {}", io::detail::quotedText(name),
                                   io::detail::quotedText(names.modelName)));
  const YamlMap::Entry& h = map.required("timestep", "the time step of the run [s]");
  if (map.number(h) != timestep)
    map.fail(
        h, fmt::format("found {:g} s, but this run has steps of {:g} s", map.number(h), timestep));
  EventFile out;
  long least = 0;
  std::size_t number = 0;
  for (const YamlValue& value : map.list(map.required("events", "a list of events"))) {
    out.events.push_back(readItem(path, value, ++number, least, names));
    least = out.events.back().step;
  }
  out.steps = readStep(map, map.required("steps", "the steps of the whole run"), least);
  return out;
}

std::string eventText(const Event& event) {
  std::string out = fmt::format("{{step: {}, {}: {{", event.step, typeOf(event.kind).name);
  for (std::size_t i = 0; i < event.fields.size(); ++i)
    out += fmt::format("{}{}: {}", i == 0 ? "" : ", ", event.fields[i].first,
                       text(event.fields[i].second));
  return out + "}}";
}

EventWriter::EventWriter(const std::filesystem::path& file, const std::string& model,
                         double timestep)
    : file_(file, "events") {
  std::string h;
  io::detail::appendNumber(h, timestep);
  file_.write(
      fmt::format("# What was done to a live run; simulate_gdd --play runs it again.\n"
                  "model: {}\ntimestep: {}\n",
                  text(FieldValue(model)), h));
}

void EventWriter::write(const Event& event) {
  if (!any_) file_.write("events:\n");
  any_ = true;
  file_.write("  - " + eventText(event) + "\n");
}

void EventWriter::finish(long steps) {
  file_.write(fmt::format("{}steps: {}\n", any_ ? "" : "events: []\n", steps));
  file_.commit();
}

}  // namespace softgauss::live
