// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a person does to a run: an event takes place between two steps.
///
/// A kind of event is a name and its fields; one table says for all of them what they may hold.
/// Pages send events as messages, files keep them, and the run takes them from either in the same
/// form.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "softgauss/engine/core/types.hpp"

namespace softgauss::live {

enum class EventKind {
  grab,
  move,
  release,
  pin,
  push,
  letGo,
  pause,
  advance,
  reset,
  back,
  gravity,
  factor,
  goal,
  target,
  joint,
  effect,
  state,
  store,
  recall,
  reload
};

/// What a field holds.
enum class FieldKind {
  link,    ///< the name of a link that moves
  goal,    ///< the name of a goal
  joint,   ///< the name of a joint of one degree of freedom
  effect,  ///< the name of an effect that can be switched
  state,   ///< the name of a state of an SRDF
  number,
  boolean,
  vector  ///< three numbers
};

struct Field {
  const char* name;
  FieldKind kind;
  bool required;
  double least, most;  ///< of a number, and of the components of a vector
  const char* unit;
};

struct EventType {
  EventKind kind;
  const char* name;
  const char* meaning;
  std::vector<Field> fields;
};

/// All kinds, in the order of EventKind.
const std::vector<EventType>& eventTypes();
const EventType& typeOf(EventKind kind);
/// Null where there is none of that name.
const EventType* findEventType(std::string_view name);

using FieldValue = std::variant<std::string, double, bool, Vector3>;

struct Event {
  EventKind kind = EventKind::release;
  long step = 0;  ///< how many steps of the run were taken before it
  std::vector<std::pair<std::string, FieldValue>> fields;  ///< in the order of the type's

  const FieldValue* find(std::string_view field) const;
  /// A field that is there, of that kind.
  const std::string& text(std::string_view field) const;
  const Vector3& vector(std::string_view field) const;
  bool flag(std::string_view field) const;
  double number(std::string_view field) const;
  /// Fields that need not be there.
  std::optional<double> maybeNumber(std::string_view field) const;
  std::optional<bool> maybeFlag(std::string_view field) const;
  std::optional<Vector3> maybeVector(std::string_view field) const;
};

/// "found 3e9, expected a number from 0 to 1e9 (N)"; empty where the value is one of the field.
std::string problemOf(const Field& field, const FieldValue& value);
/// What a message says a field expects.
std::string expectedOf(const Field& field);

}  // namespace softgauss::live
