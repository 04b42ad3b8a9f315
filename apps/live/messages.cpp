// SPDX-License-Identifier: Apache-2.0
#include "apps/live/messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "softgauss/io/detail/text.hpp"

namespace softgauss::live {
namespace {

using nlohmann::json;

constexpr int kDeepest = 4;  ///< of brackets in brackets

/// Whether brackets are not nested deeper than any message has them; strings may hold brackets.
bool isShallow(const std::string& text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c == '\\') ++i;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kDeepest) return false;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return true;
}

std::optional<FieldValue> valueOf(const json& value) {
  if (value.is_string()) return FieldValue(value.get<std::string>());
  if (value.is_boolean()) return FieldValue(value.get<bool>());
  if (value.is_number()) return FieldValue(value.get<double>());
  if (!value.is_array() || value.size() != 3) return std::nullopt;
  Vector3 v;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!value[i].is_number()) return std::nullopt;
    v[static_cast<Eigen::Index>(i)] = value[i].get<double>();
  }
  return FieldValue(v);
}

std::vector<std::string> namesOf(const std::vector<Field>& fields) {
  std::vector<std::string> names;
  for (const Field& field : fields) names.emplace_back(field.name);
  return names;
}

/// Throws std::runtime_error with the reason.
[[noreturn]] void refuse(const std::string& reason) { throw std::runtime_error(reason); }

Event readEvent(const EventType& type, const json& fields) {
  if (!fields.is_object()) refuse(fmt::format("{}: expected an object of fields", type.name));
  Event event;
  event.kind = type.kind;
  for (const Field& field : type.fields) {
    const auto found = fields.find(field.name);
    if (found == fields.end()) continue;
    const std::optional<FieldValue> value = valueOf(*found);
    if (!value)
      refuse(fmt::format("{}: '{}': expected {}", type.name, field.name, expectedOf(field)));
    event.fields.emplace_back(field.name, *value);
  }
  for (const auto& [key, value] : fields.items())
    if (!event.find(key))
      refuse(fmt::format(
          "{}: found the unknown field {}, expected {}", type.name, io::detail::quotedText(key),
          type.fields.empty() ? "{}" : "one of: " + io::detail::listed(namesOf(type.fields))));
  return event;
}

Asked readObject(const json& message, const Names& names, long& id) {
  if (!message.is_object()) refuse("expected an object");
  Asked asked;
  const EventType* type = nullptr;
  for (const auto& [key, value] : message.items()) {
    if (key == "id") {
      if (!value.is_number_integer() || value.get<double>() < 0 || value.get<double>() > 1e9)
        refuse("'id': expected a whole number from 0 to 1e9");
      id = asked.id = value.get<long>();
    }
  }
  for (const auto& [key, value] : message.items()) {
    if (key == "id") continue;
    if (type || asked.toWrite || asked.seen) refuse("expected one thing to do in a message");
    if (key == "seen") {
      if (!value.is_number_unsigned()) refuse("'seen': expected the number of messages received");
      asked.seen = static_cast<long>(
          std::min<std::uint64_t>(value.get<std::uint64_t>(),
                                  static_cast<std::uint64_t>(std::numeric_limits<long>::max())));
      continue;
    }
    if (key == "write") {
      if (!value.is_boolean() || !value.get<bool>())
        refuse("'write': expected true; who writes leaves it to others by closing the page");
      asked.toWrite = true;
      continue;
    }
    type = findEventType(key);
    if (!type) refuse("found " + io::detail::quotedText(key) + ", expected something to do");
    asked.event = readEvent(*type, value);
  }
  if (!type && !asked.toWrite && !asked.seen) refuse("expected something to do");
  if (type)
    if (const std::string problem = problemOf(asked.event, names); !problem.empty())
      refuse(problem);
  return asked;
}

template <class T>
void append(std::string& out, const std::vector<T>& values) {
  const std::size_t start = out.size(), bytes = values.size() * sizeof(T);
  out.resize(start + bytes);
  if (bytes > 0) std::memcpy(out.data() + start, values.data(), bytes);
}

template <class T>
void append(std::string& out, T value) {
  char bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  out.append(bytes, sizeof(T));
}

}  // namespace

std::variant<Asked, Refused> readMessage(const std::string& text, const Names& names) noexcept {
  long id = 0;
  try {
    if (text.size() > kLongestMessage) return Refused{0, "the message is too long"};
    if (!isShallow(text)) return Refused{0, "brackets are nested too deep"};
    const json message = json::parse(text, nullptr, false);
    if (message.is_discarded()) return Refused{0, "this is no JSON"};
    return readObject(message, names, id);
  } catch (const std::exception& error) {
    return Refused{id, error.what()};
  }
}

std::string answer(long id, const std::string& refused) {
  json out = {{"re", id}};
  if (refused.empty())
    out["done"] = true;
  else
    out["refused"] = refused;
  return out.dump(-1, ' ', true, json::error_handler_t::replace);
}

std::string frameMessage(const io::FrameTrack& frames, long steps, bool paused) {
  const auto contacts = static_cast<std::uint32_t>(frames.contactPoint.size() / 3);
  std::string out = "SGFRAME1";
  append(out, frames.time.back());
  append(out, static_cast<double>(steps));
  append(out, static_cast<std::uint32_t>(frames.pose.size() / 7));
  append(out, static_cast<std::uint32_t>(frames.goalPoint.size() / 3));
  append(out, contacts);
  append(out, static_cast<std::uint32_t>(paused ? 1 : 0));
  for (const std::vector<float>* values :
       {&frames.pose, &frames.velocity, &frames.centerOfMass, &frames.centerOfPressure,
        &frames.goalPoint, &frames.goalTarget, &frames.contactPoint, &frames.contactNormal,
        &frames.contactForce})
    append(out, *values);
  append(out, frames.contactGeometry);
  return out;
}

}  // namespace softgauss::live
