// SPDX-License-Identifier: Apache-2.0
/// Goals of what touches, or shall not: contact_force, center_of_pressure, keep_clear.

#include <fmt/format.h>

#include <algorithm>

#include "softgauss/gdd/goals/center_of_pressure.hpp"
#include "softgauss/gdd/goals/contact_force.hpp"
#include "softgauss/gdd/goals/keep_clear.hpp"
#include "softgauss/io/detail/goal_kinds.hpp"
#include "softgauss/io/detail/text.hpp"

namespace softgauss::io::detail {
namespace {

/// Names of the links that have collision geometry; with `moving` only of those that move.
std::vector<std::string> touchableLinks(const Model& model, bool moving) {
  std::vector<std::string> links;
  for (const Geometry& g : model.geometries) {
    const bool known = std::find(links.begin(), links.end(), g.link) != links.end();
    if (!known && !(moving && g.body == 0)) links.push_back(g.link);
  }
  return links;
}

/// Fails unless the link is one of `links`.
void expectTouchable(const YamlMap& keys, const YamlMap::Entry& entry, const std::string& found,
                     const std::string& link, const std::vector<std::string>& links,
                     const Model& model, const char* what) {
  if (std::find(links.begin(), links.end(), link) != links.end()) return;
  keys.fail(entry, fmt::format("found {}, expected {} of model '{}' with collision geometry{}",
                               found, what, model.name, suggestion(link, links)));
}

}  // namespace

GoalPointer readContactForce(const YamlMap& keys, const GoalScene& scene) {
  const Model& model = scene.model;
  const YamlMap::Entry& entry = keys.required("link", "the name of a link");
  const std::string link = movingLink(keys, entry, model);
  expectTouchable(keys, entry, quotedText(link), link, touchableLinks(model, true), model,
                  "a link");
  const Vector3 force = keys.vector3(keys.required("force", "three numbers [x, y, z]"));
  auto goal = std::make_unique<gdd::ContactForce>(model, link, force);
  if (const auto* axes = keys.find("axes")) goal->axes = readAxes(keys, *axes);
  if (const auto* by = keys.find("by")) {
    const std::string other = keys.name(*by);
    if (other != "world")
      expectTouchable(keys, *by, quotedText(other), other, touchableLinks(model, false), model,
                      "world or a link");
    if (other == link) keys.fail(*by, "found the link itself, expected world or another link");
    goal->countOnly(model, other);
  }
  keys.read("weight", goal->weight, Range::notNegative);
  return goal;
}

GoalPointer readKeepClear(const YamlMap& keys, const GoalScene& scene) {
  const Model& model = scene.model;
  const YamlMap::Entry& entry = keys.required("link", "the name of a link");
  const std::string link = movingLink(keys, entry, model);
  expectTouchable(keys, entry, quotedText(link), link, touchableLinks(model, true), model,
                  "a link");
  const YamlMap::Entry& other = keys.required("from", "world or the name of a link");
  const std::string from = keys.name(other);
  if (from != "world")
    expectTouchable(keys, other, quotedText(from), from, touchableLinks(model, false), model,
                    "world or a link");
  if (gdd::KeepClear::pairsOf(model, link, from).empty())
    keys.fail(other, fmt::format("found {}, expected a link with shapes that move against those of "
                                 "{}, and that no joint joins to it",
                                 quotedText(from), quotedText(link)));
  double distance = 0.0;
  keys.required("distance", "a number of metres");
  keys.read("distance", distance, Range::notNegative);
  if (!scene.distances) keys.fail(entry, "found without a source of shape distances");
  auto goal = std::make_unique<gdd::KeepClear>(model, link, from, distance, scene.distances(model));
  readWeight(keys, *goal);
  keys.read("stiffness", goal->stiffness, Range::notNegative);
  keys.read("damping", goal->damping, Range::notNegative);
  return goal;
}

GoalPointer readCenterOfPressure(const YamlMap& keys, const GoalScene& scene) {
  const Model& model = scene.model;
  const Vector3 target = keys.vector3(keys.required("target", "three numbers [x, y, z]"));
  const YamlMap::Entry* entry = keys.find("links");
  if (entry && keys.find("link")) keys.fail(*entry, "found beside link, expected one of them");
  const int robot = entry ? -1 : readRobot(keys, model);
  auto goal = std::make_unique<gdd::CenterOfPressure>(model, robot, target);
  if (entry) {
    std::vector<std::string> links;
    for (const YamlValue& item : keys.list(*entry)) {
      expectTouchable(keys, *entry, item.described(), item.text, touchableLinks(model, true), model,
                      "links that move");
      if (std::find(links.begin(), links.end(), item.text) != links.end())
        keys.fail(*entry, fmt::format("found {} twice, expected once", item.described()));
      links.push_back(item.text);
    }
    if (links.empty()) keys.fail(*entry, "found an empty list, expected at least one link");
    goal->countOnly(model, links);
  }
  keys.read("weight", goal->weight, Range::notNegative);
  return goal;
}

}  // namespace softgauss::io::detail
