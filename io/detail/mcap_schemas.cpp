// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/detail/mcap_schemas.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace softgauss::io::detail {
namespace {

using Json = nlohmann::ordered_json;
using Members = std::vector<std::pair<std::string, Json>>;

const Json kNumber = {{"type", "number"}};
const Json kText = {{"type", "string"}};
const Json kInteger = {{"type", "integer"}};

Json object(const std::string& title, const Members& members) {
  Json json = {{"title", title}, {"type", "object"}, {"properties", Json::object()}};
  for (const auto& [name, schema] : members) json["properties"][name] = schema;
  return json;
}

Json list(const Json& items) { return {{"type", "array"}, {"items", items}}; }

Json numbers(const std::string& title, const std::vector<std::string>& names) {
  Members members;
  for (const std::string& name : names) members.emplace_back(name, kNumber);
  return object(title, members);
}

/// Readers know them by their titles.
Json time() { return object("time", {{"sec", kInteger}, {"nsec", kInteger}}); }
Json duration() { return object("duration", {{"sec", kInteger}, {"nsec", kInteger}}); }
Json vector3() { return numbers("foxglove.Vector3", {"x", "y", "z"}); }
Json point3() { return numbers("foxglove.Point3", {"x", "y", "z"}); }
Json quaternion() { return numbers("foxglove.Quaternion", {"x", "y", "z", "w"}); }
Json color() { return numbers("foxglove.Color", {"r", "g", "b", "a"}); }
Json pose() {
  return object("foxglove.Pose", {{"position", vector3()}, {"orientation", quaternion()}});
}

Json primitive(const std::string& kind, Members members) {
  members.emplace(members.begin(), "pose", pose());
  members.emplace_back("color", color());
  return list(object("foxglove." + kind + "Primitive", members));
}

Json entity() {
  const Json pair = object("foxglove.KeyValuePair", {{"key", kText}, {"value", kText}});
  return object("foxglove.SceneEntity",
                {{"timestamp", time()},
                 {"frame_id", kText},
                 {"id", kText},
                 {"lifetime", duration()},
                 {"frame_locked", {{"type", "boolean"}}},
                 {"metadata", list(pair)},
                 {"arrows", primitive("Arrow", {{"shaft_length", kNumber},
                                                {"shaft_diameter", kNumber},
                                                {"head_length", kNumber},
                                                {"head_diameter", kNumber}})},
                 {"cubes", primitive("Cube", {{"size", vector3()}})},
                 {"spheres", primitive("Sphere", {{"size", vector3()}})},
                 {"cylinders", primitive("Cylinder", {{"size", vector3()},
                                                      {"bottom_scale", kNumber},
                                                      {"top_scale", kNumber}})},
                 {"lines", primitive("Line", {})},
                 {"triangles", primitive("TriangleList", {{"points", list(point3())},
                                                          {"colors", list(color())},
                                                          {"indices", list(kInteger)}})},
                 {"texts", primitive("Text", {})},
                 {"models", primitive("Model", {})}});
}

}  // namespace

std::string transformsSchema() {
  const Json transform = object("foxglove.FrameTransform", {{"timestamp", time()},
                                                            {"parent_frame_id", kText},
                                                            {"child_frame_id", kText},
                                                            {"translation", vector3()},
                                                            {"rotation", quaternion()}});
  return object("foxglove.FrameTransforms", {{"transforms", list(transform)}}).dump();
}

std::string sceneSchema() {
  const Json deletion = object("foxglove.SceneEntityDeletion",
                               {{"timestamp", time()}, {"type", kInteger}, {"id", kText}});
  return object("foxglove.SceneUpdate",
                {{"deletions", list(deletion)}, {"entities", list(entity())}})
      .dump();
}

std::string jointStatesSchema() {
  const Json joint = object("foxglove.JointState", {{"name", kText},
                                                    {"position", kNumber},
                                                    {"velocity", kNumber},
                                                    {"acceleration", kNumber},
                                                    {"effort", kNumber}});
  return object("foxglove.JointStates", {{"timestamp", time()}, {"joints", list(joint)}}).dump();
}

std::string numbersSchema(const std::string& title, const std::vector<NumberField>& fields) {
  Members members = {{"timestamp", time()}};
  for (const auto& [name, parts] : fields)
    members.emplace_back(name, parts.empty() ? kNumber : numbers(name, parts));
  return object(title, members).dump();
}

}  // namespace softgauss::io::detail
