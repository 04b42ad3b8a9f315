// SPDX-License-Identifier: Apache-2.0
#include "softgauss/io/mjcf/replicate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "softgauss/io/mjcf/pose.hpp"

namespace softgauss::io::mjcf {
namespace {

/// More make no model that could be built, however short the file that asks for them.
constexpr std::size_t kMostElements = 200'000;

std::size_t sizeOf(const Element& element) {
  std::size_t size = 1;
  for (const Element& child : element.children) size += sizeOf(child);
  return size;
}

void rename(Element& element, const std::string& suffix) {
  for (auto& [attribute, value] : element.attributes)
    if (attribute == "name" && !value.empty()) value += suffix;
  for (Element& child : element.children) rename(child, suffix);
}

/// What is in an element, with frames in place of each <replicate>.
void expand(Element& element, const Compiler& compiler, std::size_t& total) {
  std::vector<Element> children;
  for (Element& child : element.children) {
    if (child.tag == "replicate") {
      for (Element& frame : replicated(child, compiler, total))
        children.push_back(std::move(frame));
    } else {
      expand(child, compiler, total);
      children.push_back(std::move(child));
    }
  }
  element.children = std::move(children);
}

/// A <frame> in place of copy i, without its children.
Element frameOf(const Element& element, const Vector3& place, const Matrix3& R) {
  Element frame;
  frame.tag = "frame";
  frame.where = element.where;
  const Quaternion q(R);
  frame.attributes = {
      {"pos", fmt::format("{:.17g} {:.17g} {:.17g}", place.x(), place.y(), place.z())},
      {"quat", fmt::format("{:.17g} {:.17g} {:.17g} {:.17g}", q.w(), q.x(), q.y(), q.z())}};
  if (element.has("childclass"))
    frame.attributes.emplace_back("childclass", element.requiredText("childclass"));
  return frame;
}

}  // namespace

std::vector<Element> replicated(const Element& element, const Compiler& compiler,
                                std::size_t& total) {
  element.expectAttributes({"count", "offset", "euler", "sep", "childclass"});
  int count = 0;
  if (!element.read("count", count)) element.fail("has no attribute 'count'");
  if (count < 0) element.fail(fmt::format("count is {}, expected 0 or more", count));
  Vector3 offset = Vector3::Zero(), euler = Vector3::Zero();
  element.read("offset", offset);
  element.read("euler", euler);
  Element inner = element;
  expand(inner, compiler, total);
  const std::size_t size = sizeOf(inner);
  if (static_cast<std::size_t>(count) > (kMostElements - std::min(total, kMostElements)) / size)
    element.fail(
        fmt::format("makes, with other copies of the file, more than {} elements; expected a lower "
                    "count",
                    kMostElements));
  total += static_cast<std::size_t>(count) * size;
  const std::size_t digits = std::to_string(count).size();
  std::vector<Element> frames;
  Vector3 place = Vector3::Zero();
  for (int i = 0; i < count; ++i) {
    PoseAttributes pose;
    pose.kind = PoseAttributes::Kind::euler;
    pose.numbers = {i * euler.x(), i * euler.y(), i * euler.z()};
    const Matrix3 R = pose.pose(element, compiler).R;
    Element frame = frameOf(element, place, R);
    frame.children = inner.children;
    rename(frame, fmt::format("{}{:0{}}", element.text("sep"), i, digits));
    frames.push_back(std::move(frame));
    place += R * offset;
  }
  return frames;
}

}  // namespace softgauss::io::mjcf
