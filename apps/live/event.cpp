// SPDX-License-Identifier: Apache-2.0
#include "apps/live/event.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/live/keyframes.hpp"

namespace softgauss::live {
namespace {

constexpr double kFarthest = 1e6;                           // [m]
constexpr double kStrongest = 1e6;                          // [N or N m]
constexpr double kHeaviest = 1e12;                          // weights, stiffness
constexpr double kLongestBack = 3600;                       // [s]
constexpr double kShortestLine = 0.01, kLongestLine = 100;  // of minimum jerk [s]

constexpr Field name(const char* field, FieldKind kind) {
  return {field, kind, true, 0.0, 0.0, ""};
}
constexpr Field place(const char* field) {
  return {field, FieldKind::vector, true, -kFarthest, kFarthest, "m"};
}
constexpr Field option(const char* field, const char* unit) {
  return {field, FieldKind::number, false, 0.0, kHeaviest, unit};
}

template <class T>
const T* valueIn(const FieldValue* value) {
  return value ? std::get_if<T>(value) : nullptr;
}

template <class T>
std::optional<T> maybe(const FieldValue* value) {
  const T* found = valueIn<T>(value);
  return found ? std::optional<T>(*found) : std::nullopt;
}

std::vector<EventType> makeTypes() {
  using K = FieldKind;
  const Field force{"force", K::vector, false, -kStrongest, kStrongest, "N"};
  const Field slot{"slot", K::number, true, 1.0, Keyframes::kSlots, "of nine"};
  const Field torque{"torque", K::vector, false, -kStrongest, kStrongest, "N m"};
  return {
      {EventKind::grab,
       "grab",
       "a point of a link gets a spatial goal",
       {name("link", K::link),
        place("point"),
        place("target"),
        option("weight", "kg"),
        option("stiffness", "1/s²"),
        option("damping", "1/s"),
        {"duration", K::number, false, kShortestLine, kLongestLine, "s"}}},
      {EventKind::move, "move", "the grabbed point's goal moves", {place("target")}},
      {EventKind::release, "release", "the grabbed point's goal ends", {}},
      {EventKind::pin, "pin", "the grabbed point is let go and its goal stays", {}},
      {EventKind::push,
       "push",
       "a force on a point of a link, and a torque, until let go",
       {name("link", K::link), place("point"), force, torque}},
      {EventKind::letGo, "let_go", "the push ends", {}},
      {EventKind::pause,
       "pause",
       "time stands still or goes on",
       {{"on", K::boolean, true, 0, 0, ""}}},
      {EventKind::advance,
       "advance",
       "a paused run takes so many steps",
       {{"count", K::number, true, 1.0, 1000.0, "steps"}}},
      {EventKind::reset, "reset", "the state is that of the start", {}},
      {EventKind::back,
       "back",
       "the state is that of so long ago",
       {{"seconds", K::number, true, 0.0, kLongestBack, "s"}}},
      {EventKind::gravity,
       "gravity",
       "gravity changes",
       {{"acceleration", K::vector, true, -1000.0, 1000.0, "m/s²"}}},
      {EventKind::factor,
       "factor",
       "time passes so many times as fast as the clock",
       {{"value", K::number, true, 0.01, 100.0, "times"}}},
      {EventKind::goal,
       "goal",
       "a goal is switched or weighs anew",
       {name("goal", K::goal),
        {"on", K::boolean, false, 0, 0, ""},
        option("weight", "of its kind"),
        option("stiffness", "1/s²"),
        option("damping", "1/s"),
        option("rate", "1/s")}},
      {EventKind::target,
       "target",
       "the place that a goal seeks moves",
       {name("goal", K::goal), place("place")}},
      {EventKind::joint,
       "joint",
       "a joint of a paused run is put there, else postures and plans seek it there",
       {name("joint", K::joint), {"position", K::number, true, -kFarthest, kFarthest, "rad or m"}}},
      {EventKind::effect,
       "effect",
       "an effect is switched",
       {name("effect", K::effect), {"on", K::boolean, true, 0, 0, ""}}},
      {EventKind::state, "state", "the run is put into a state", {name("state", K::state)}},
      {EventKind::store, "store", "the state is kept", {slot}},
      {EventKind::recall, "recall", "the run is put into a state that was kept", {slot}},
      {EventKind::reload, "reload", "a live run begins anew with its files as they are now", {}},
  };
}

}  // namespace

const std::vector<EventType>& eventTypes() {
  static const std::vector<EventType> types = makeTypes();
  return types;
}

const EventType& typeOf(EventKind kind) { return eventTypes()[static_cast<std::size_t>(kind)]; }

const EventType* findEventType(std::string_view name) {
  for (const EventType& type : eventTypes())
    if (type.name == name) return &type;
  return nullptr;
}

const FieldValue* Event::find(std::string_view field) const {
  for (const auto& [name, value] : fields)
    if (name == field) return &value;
  return nullptr;
}

const std::string& Event::text(std::string_view field) const {
  return std::get<std::string>(*find(field));
}
const Vector3& Event::vector(std::string_view field) const {
  return std::get<Vector3>(*find(field));
}
bool Event::flag(std::string_view field) const { return std::get<bool>(*find(field)); }
double Event::number(std::string_view field) const { return std::get<double>(*find(field)); }

std::optional<double> Event::maybeNumber(std::string_view field) const {
  return maybe<double>(find(field));
}
std::optional<bool> Event::maybeFlag(std::string_view field) const {
  return maybe<bool>(find(field));
}
std::optional<Vector3> Event::maybeVector(std::string_view field) const {
  return maybe<Vector3>(find(field));
}

std::string expectedOf(const Field& field) {
  const std::string range = fmt::format("from {:g} to {:g}", field.least, field.most);
  switch (field.kind) {
    case FieldKind::link:
      return "the name of a link that moves";
    case FieldKind::goal:
      return "the name of a goal";
    case FieldKind::joint:
      return "the name of a joint of one degree of freedom";
    case FieldKind::effect:
      return "the name of an effect";
    case FieldKind::state:
      return "the name of a state of the robot's SRDF";
    case FieldKind::number:
      return fmt::format("a number {} [{}]", range, field.unit);
    case FieldKind::boolean:
      return "true or false";
    case FieldKind::vector:
      return fmt::format("three numbers {} [{}]", range, field.unit);
  }
  return "";
}

std::string problemOf(const Field& field, const FieldValue& value) {
  const auto within = [&](double x) {
    return std::isfinite(x) && x >= field.least && x <= field.most;
  };
  bool fits = false;
  std::string found;
  if (std::holds_alternative<std::string>(value)) {
    fits = field.kind == FieldKind::link || field.kind == FieldKind::goal ||
           field.kind == FieldKind::joint || field.kind == FieldKind::effect ||
           field.kind == FieldKind::state;
    found = "a text";
  } else if (const auto* x = std::get_if<double>(&value)) {
    fits = field.kind == FieldKind::number && within(*x);
    found = fmt::format("{:g}", *x);
  } else if (std::holds_alternative<bool>(value)) {
    fits = field.kind == FieldKind::boolean;
    found = std::get<bool>(value) ? "true" : "false";
  } else {
    const Vector3& v = std::get<Vector3>(value);
    fits = field.kind == FieldKind::vector &&
           std::all_of(v.data(), v.data() + 3, [&](double c) { return within(c); });
    found = fmt::format("[{:g}, {:g}, {:g}]", v.x(), v.y(), v.z());
  }
  return fits ? "" : fmt::format("found {}, expected {}", found, expectedOf(field));
}

}  // namespace softgauss::live
