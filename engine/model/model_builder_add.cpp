// SPDX-License-Identifier: Apache-2.0
/// One description beside another: names get a prefix, roots keep how they meet the world.

#include <algorithm>
#include <set>
#include <utility>

#include "softgauss/engine/model/model_builder.hpp"

namespace softgauss {

std::vector<std::string> ModelBuilder::rootLinks() const {
  std::set<std::string> children;
  for (const JointSpec& joint : joints_) children.insert(joint.child);
  std::vector<std::string> roots;
  for (const LinkSpec& link : links_)
    if (!children.count(link.name)) roots.push_back(link.name);
  return roots;
}

ModelBuilder& ModelBuilder::add(const ModelBuilder& other, const std::string& prefix) {
  const auto own = [&](const std::string& name) {
    return prefix.empty() ? name : prefix + "/" + name;
  };
  std::set<std::string> links;
  for (const LinkSpec& link : other.links_) links.insert(link.name);
  const std::vector<std::string> rootList = other.rootLinks();
  const std::set<std::string> otherRoots(rootList.begin(), rootList.end());
  // "world" means the world where the other has no link of that name.
  const auto linkName = [&](const std::string& link) {
    return links.count(link) ? own(link) : link;
  };

  for (LinkSpec link : other.links_) {
    if (otherRoots.count(link.name)) {
      const auto root = std::find_if(other.roots_.begin(), other.roots_.end(),
                                     [&](const Root& r) { return r.link == link.name; });
      const BaseKind kind = root == other.roots_.end() ? other.base : root->base;
      const bool floats =
          kind == BaseKind::floating || (kind == BaseKind::automatic && link.name != "world");
      roots_.push_back({own(link.name), floats ? BaseKind::floating : BaseKind::fixed,
                        root == other.roots_.end() ? other.X_WRoot : root->X_WRoot,
                        root == other.roots_.end() ? link.name == "world" : root->isWorld});
    }
    link.name = own(link.name);
    links_.push_back(std::move(link));
  }
  for (JointSpec joint : other.joints_) {
    joint.name = own(joint.name);
    joint.parent = linkName(joint.parent);
    joint.child = linkName(joint.child);
    if (joint.mimic) joint.mimic->leader = own(joint.mimic->leader);
    if (other.zeroEffortIsUnlimited && joint.effort == 0.0) joint.effort.reset();
    joints_.push_back(std::move(joint));
  }
  for (GeometrySpec geometry : other.geometries_) {
    geometry.name = own(geometry.name);
    geometry.link = linkName(geometry.link);
    geometries_.push_back(std::move(geometry));
  }
  for (PairSpec pair : other.pairs_) {
    pair.geometryA = own(pair.geometryA);
    pair.geometryB = own(pair.geometryB);
    pairs_.push_back(std::move(pair));
  }
  for (const auto& [linkA, linkB] : other.apart_) keepApart(linkName(linkA), linkName(linkB));
  const auto tie = [&](const auto& specs, auto& all) {
    for (auto spec : specs) {
      spec.linkA = linkName(spec.linkA);
      spec.linkB = linkName(spec.linkB);
      all.push_back(std::move(spec));
    }
  };
  tie(other.connections_, connections_);
  tie(other.welds_, welds_);
  for (CouplingSpec coupling : other.couplings_) {
    coupling.follower = own(coupling.follower);
    if (!coupling.leader.empty()) coupling.leader = own(coupling.leader);
    couplings_.push_back(std::move(coupling));
  }
  for (VisualSpec visual : other.visuals_) {
    visual.link = linkName(visual.link);
    visuals_.push_back(std::move(visual));
  }
  for (const std::string& text : other.warnings_)
    warnings_.push_back(prefix.empty() ? text : prefix + ": " + text);
  return *this;
}

}  // namespace softgauss
