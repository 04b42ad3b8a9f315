// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/model/detail/kinematic_tree.hpp"

#include "softgauss/engine/core/index.hpp"

namespace softgauss::detail {
namespace {

/// " (line 12)", or nothing when the line is unknown.
std::string atLine(const SourceLocation& where) {
  return where.line > 0 ? " (line " + std::to_string(where.line) + ")" : std::string();
}

}  // namespace

LinkOrder orderLinks(const std::string& modelName, const std::vector<LinkSpec>& links,
                     const std::vector<JointSpec>& joints) {
  LinkOrder order;
  if (links.empty()) throw ModelError({}, "model '" + modelName + "'", "has no links");

  for (std::size_t i = 0; i < links.size(); ++i) {
    const auto [it, isNew] = order.indexOf.emplace(links[i].name, static_cast<int>(i));
    if (!isNew)
      throw ModelError(links[i].where, "link '" + links[i].name + "'",
                       "is defined twice, first" + atLine(links[idx(it->second)].where));
  }

  // Parent joint of every link, children in the order in which joints are listed.
  std::unordered_map<std::string, int> jointNames;
  std::vector<int> parentJoint(links.size(), -1);
  std::vector<std::vector<TreeEdge>> children(links.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const JointSpec& joint = joints[j];
    const std::string element = "joint '" + joint.name + "'";
    if (!jointNames.emplace(joint.name, static_cast<int>(j)).second)
      throw ModelError(joint.where, element, "is defined twice");
    const int parent = order.find(joint.parent), child = order.find(joint.child);
    if (parent < 0)
      throw ModelError(joint.where, element, "parent link '" + joint.parent + "' does not exist");
    if (child < 0)
      throw ModelError(joint.where, element, "child link '" + joint.child + "' does not exist");
    if (child == parent)
      throw ModelError(joint.where, element, "joins link '" + joint.child + "' to itself: a cycle");
    int& above = parentJoint[idx(child)];
    if (above >= 0)
      throw ModelError(joint.where, element,
                       "link '" + joint.child + "' has two parents: joint '" +
                           joints[idx(above)].name + "'" + atLine(joints[idx(above)].where) +
                           " and this one; expected one");
    above = static_cast<int>(j);
    children[idx(parent)].push_back({static_cast<int>(j), parent, child});
  }

  for (const JointSpec& joint : joints)
    if (joint.type == JointType::planar)
      for (const char* part : kPlanarParts)
        if (const auto other = jointNames.find(joint.name + part); other != jointNames.end())
          throw ModelError(joints[idx(other->second)].where, "joint '" + other->first + "'",
                           "has the name of a part of the planar joint '" + joint.name + "'" +
                               atLine(joint.where) + ", expected a name of its own");

  // Depth first from every root, without recursion: chains may be thousands of links long.
  std::vector<bool> seen(links.size(), false);
  std::vector<TreeEdge> stack;
  for (std::size_t root = 0; root < links.size(); ++root) {
    if (parentJoint[root] >= 0) continue;
    stack.push_back({-1, -1, static_cast<int>(root)});
    while (!stack.empty()) {
      const TreeEdge edge = stack.back();
      stack.pop_back();
      seen[idx(edge.child)] = true;
      order.visits.push_back(edge);
      const auto& next = children[idx(edge.child)];
      stack.insert(stack.end(), next.rbegin(), next.rend());
    }
  }
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (seen[i]) continue;
    const JointSpec& joint = joints[idx(parentJoint[i])];
    throw ModelError(
        joint.where, "joint '" + joint.name + "'",
        "link '" + links[i].name + "' is part of a cycle; expected a tree of links with a root");
  }
  return order;
}

}  // namespace softgauss::detail
