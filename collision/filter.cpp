// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/filter.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

namespace softgauss::collision {
namespace {

bool isPlane(const Geometry& g) { return g.shape.kind == ShapeKind::plane; }

/// Both of one robot, whose designer may let them overlap: they move, or one is of the base that
/// carries the other. Scenery and the bases of other robots are of no robot here.
bool ofOneRobot(const Model& model, const Geometry& a, const Geometry& b) {
  if (a.body == 0 || b.body == 0) return a.base >= 0 && a.base == b.base;
  return contactEffect(model, a.body, b.body) == Effect::selfCollision;
}

bool hasGeometry(const Model& model, int body) {
  return std::any_of(model.geometries.begin(), model.geometries.end(),
                     [&](const Geometry& g) { return g.body == body; });
}

/// The nearest ancestor with mass or shapes; −1 above a floating base, which hangs from nothing.
int solidParent(const Model& model, int body) {
  const auto at = [&](int b) -> const Body& { return model.bodies[static_cast<std::size_t>(b)]; };
  while (body != 0) {
    if (at(body).joint == JointKind::floating) return -1;
    body = at(body).parent;
    if (body == 0 || !at(body).massless || hasGeometry(model, body)) return body;
  }
  return -1;
}

/// Two links of two bodies, in a fixed order. The number tells apart robots with equal names.
using LinkPair = std::array<std::pair<int, std::string>, 2>;

LinkPair linkPair(const Model& model, const Geometry& a, const Geometry& b) {
  const auto robot = [&](const Geometry& g) {
    return model.bodies[static_cast<std::size_t>(g.body)].robot;
  };
  LinkPair links{std::pair{robot(a), a.link}, std::pair{robot(b), b.link}};
  if (links[1] < links[0]) std::swap(links[0], links[1]);
  return links;
}

/// Whether geometries are never to be tested, as Model::apart names their links.
class Apart {
 public:
  explicit Apart(const Model& model) {
    if (model.apart.empty()) return;
    std::map<std::string, int> links;
    const auto link = [&](const std::string& name) {
      return links.emplace(name, static_cast<int>(links.size())).first->second;
    };
    for (const auto& [a, b] : model.apart) pairs_.insert(std::minmax({link(a), link(b)}));
    for (const Geometry& g : model.geometries) {
      const auto found = links.find(g.link);
      link_.push_back(found == links.end() ? -1 : found->second);
    }
  }
  bool has(int a, int b) const {
    if (link_.empty()) return false;
    const int i = link_[static_cast<std::size_t>(a)], j = link_[static_cast<std::size_t>(b)];
    return i >= 0 && j >= 0 && pairs_.count(std::minmax({i, j})) > 0;
  }

 private:
  std::set<std::pair<int, int>> pairs_;
  std::vector<int> link_;  ///< of each geometry, −1: in no pair
};

/// Pairs that are tested whatever else holds.
std::set<std::pair<int, int>> pairsTestedAlways(const Model& model) {
  std::set<std::pair<int, int>> pairs;
  for (const ContactPair& pair : model.contactPairs)
    if (pair.always) pairs.emplace(pair.geometryA, pair.geometryB);
  return pairs;
}

/// For each geometry the first one behind it that is of another body.
std::vector<int> endsOfRuns(const Model& model) {
  std::vector<int> ends(model.geometries.size());
  for (std::size_t i = ends.size(); i-- > 0;) {
    const bool isLast = i + 1 == ends.size();
    ends[i] = isLast || model.geometries[i].body != model.geometries[i + 1].body
                  ? static_cast<int>(i + 1)
                  : ends[i + 1];
  }
  return ends;
}

bool adjacentThroughParents(const std::vector<int>& parents, int a, int b) {
  return parents[static_cast<std::size_t>(a)] == b || parents[static_cast<std::size_t>(b)] == a;
}

/// Into the order of PairFilter::pairs.
void sortPairs(const Model& model, std::vector<GeometryPair>& pairs) {
  const auto rank = [&](const GeometryPair& p) {
    return std::make_pair(!isPlane(model.geometries[static_cast<std::size_t>(p.a)]),
                          std::make_pair(p.a, p.b));
  };
  std::sort(pairs.begin(), pairs.end(),
            [&](const GeometryPair& x, const GeometryPair& y) { return rank(x) < rank(y); });
}

}  // namespace

Effect contactEffect(const Model& model, int bodyA, int bodyB) {
  if (bodyA == 0 || bodyB == 0) return Effect::groundContact;
  const bool oneRobot = model.bodies[static_cast<std::size_t>(bodyA)].robot ==
                        model.bodies[static_cast<std::size_t>(bodyB)].robot;
  return oneRobot ? Effect::selfCollision : Effect::objectContact;
}

GeometryPair inOrder(const Model& model, int i, int j) {
  const auto kind = [&](int g) { return model.geometries[static_cast<std::size_t>(g)].shape.kind; };
  return kind(j) < kind(i) ? GeometryPair{j, i} : GeometryPair{i, j};
}

PairFilter makePairFilter(const Model& model, const InitialDistance& initialDistance,
                          const StayApart& stayApart) {
  PairFilter filter;
  std::vector<int> parents;
  for (int b = 0; b < model.bodyCount(); ++b) parents.push_back(solidParent(model, b));

  std::map<LinkPair, ExcludedPair> excluded;
  const auto entry = [&](const Geometry& a, const Geometry& b) -> ExcludedPair& {
    const LinkPair links = linkPair(model, a, b);
    ExcludedPair& pair = excluded[links];
    pair.linkA = links[0].second;
    pair.linkB = links[1].second;
    pair.withBase = a.body == 0 || b.body == 0;
    return pair;
  };

  // First pass: what no configuration can change, and the overlaps in the initial one.
  std::vector<GeometryPair> candidates;
  const int count = static_cast<int>(model.geometries.size());
  const std::vector<int> runEnds = endsOfRuns(model);
  const Apart apart(model);
  const std::set<std::pair<int, int>> always = pairsTestedAlways(model);
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      const Geometry& a = model.geometries[static_cast<std::size_t>(i)];
      const Geometry& b = model.geometries[static_cast<std::size_t>(j)];
      if (a.body == b.body) {
        // All of one body in a row at once: scenery may be a hundred thousand shapes.
        const int end = runEnds[static_cast<std::size_t>(j)];
        filter.rigidPairs += end - j;
        j = end - 1;
        continue;
      }
      if (always.count({i, j})) {
        if (model.options.effects.has(contactEffect(model, a.body, b.body)))
          filter.pairs.push_back(inOrder(model, i, j));
        else
          ++filter.effectOffPairs;
        continue;
      }
      if (!mayTouch(a.bits, b.bits)) {
        ++filter.disjointPairs;
        continue;
      }
      const bool oneRobot = ofOneRobot(model, a, b);
      if (oneRobot && adjacentThroughParents(parents, a.body, b.body)) {
        ExcludedPair& pair = entry(a, b);
        pair.reason = ExclusionReason::adjacent;
        ++pair.geometryPairs;
        continue;
      }
      if (apart.has(i, j)) {
        ExcludedPair& pair = entry(a, b);
        pair.reason = ExclusionReason::disabled;
        ++pair.geometryPairs;
        continue;
      }
      if (!model.options.effects.has(contactEffect(model, a.body, b.body))) {
        ++filter.effectOffPairs;
        continue;
      }
      const GeometryPair pair = inOrder(model, i, j);
      if (stayApart && stayApart(pair)) {
        ++filter.unreachablePairs;
        continue;
      }
      candidates.push_back(pair);
      if (!oneRobot) continue;
      const double depth = -initialDistance(pair);
      if (depth <= kInitialOverlap) continue;
      ExcludedPair& overlap = entry(a, b);
      overlap.reason = ExclusionReason::overlapsInitially;
      overlap.depth = std::max(overlap.depth, depth);
    }
  }

  // Second pass: the other geometries of overlapping links go with them.
  for (const GeometryPair& pair : candidates) {
    const Geometry& a = model.geometries[static_cast<std::size_t>(pair.a)];
    const Geometry& b = model.geometries[static_cast<std::size_t>(pair.b)];
    if (ofOneRobot(model, a, b)) {
      const auto found = excluded.find(linkPair(model, a, b));
      if (found != excluded.end() && found->second.reason == ExclusionReason::overlapsInitially) {
        ++found->second.geometryPairs;
        continue;
      }
    }
    filter.pairs.push_back(pair);
  }
  sortPairs(model, filter.pairs);
  for (auto& [names, pair] : excluded) filter.excluded.push_back(std::move(pair));
  return filter;
}

std::string describe(const ExcludedPair& pair) {
  std::string text = pair.linkA + " – " + pair.linkB + ": ";
  if (pair.reason == ExclusionReason::adjacent) {
    text += "joined by a joint";
  } else if (pair.reason == ExclusionReason::disabled) {
    text += "never tested, as the SRDF says";
  } else {
    char depth[48];
    std::snprintf(depth, sizeof depth, "overlap by %.3g mm at the start", 1e3 * pair.depth);
    text += depth;
  }
  return text + " (" + std::to_string(pair.geometryPairs) +
         (pair.geometryPairs == 1 ? " pair)" : " pairs)");
}

std::optional<std::string> baseWarning(const PairFilter& filter) {
  constexpr int kMostTold = 8;
  std::string told;
  int count = 0;
  for (const ExcludedPair& pair : filter.excluded)
    if (pair.withBase && pair.reason != ExclusionReason::disabled && ++count <= kMostTold)
      told += (count > 1 ? "; " : "") + describe(pair);
  if (count == 0) return std::nullopt;
  if (count > kMostTold)
    told += " and " + std::to_string(count - kMostTold) + " more, which --explain lists";
  return "never tested for contact, as parts of one robot with its fixed base: " + told +
         "; to let such a part stop the robot, make it an object of its own, or a link fixed to "
         "'world'";
}

}  // namespace softgauss::collision
