// SPDX-License-Identifier: Apache-2.0
#include "softgauss/collision/detail/neighbours.hpp"

#include <algorithm>

#include "softgauss/collision/tunnelling.hpp"
#include "softgauss/engine/constraints/contact.hpp"
#include "softgauss/engine/core/index.hpp"

namespace softgauss::collision::detail {
Neighbours::Neighbours(const Model& model, const Units& units, PreparedMeshes& meshes)
    : set_(model, meshes),
      units_(units),
      parts_(idx(units.size())),
      bodies_(model.trees.size()),
      centre_(model.geometries.size(), Vector3::Zero()),
      way_(model.geometries.size(), 0.0),
      X_WG_(model.geometries.size()),
      posed_(idx(units.size()), 0),
      box_(idx(units.size())),
      fat_(idx(units.size())),
      near_(idx(units.size())),
      awake_(idx(units.size()), 0) {
  const std::vector<double> marginShares = set_.marginShares();
  for (int g = 0; g < static_cast<int>(model.geometries.size()); ++g) {
    const Geometry& geometry = model.geometries[idx(g)];
    const int tree = model.bodies[idx(geometry.body)].tree;
    if (tree < 0) continue;
    parts_[idx(units.ofTree[idx(tree)])].push_back(
        {g, tree, geometry.body - model.trees[idx(tree)].rootBody,
         geometry.X_BG * set_.centreInG[idx(g)],
         set_.isPlane(g) ? kInfinity : set_.radius[idx(g)] + marginShares[idx(g)],
         extentOf(geometry.shape, set_.hull[idx(g)].get(), set_.surface[idx(g)].get()).lever});
  }
}

void Neighbours::place(int tree, const TreeMotionView& bodies) noexcept {
  bodies_[idx(tree)] = bodies;
  const int unit = units_.ofTree[idx(tree)];
  if (moved_.empty() || moved_.back() != unit) moved_.push_back(unit);
}

double Neighbours::wayOf(const Part& part, const Vector3& centre) const {
  const Options& options = set_.model.options;
  if (!options.hasRowLaw()) return 0.0;
  const TreeMotionView& tree = bodies_[idx(part.tree)];
  const Motion& V = tree.V[idx(part.bodyInTree)];
  const Vector3 v = V.linear + V.angular.cross(centre - *tree.p_WO);
  return options.timeToNextRows() * (v.norm() + V.angular.norm() * part.lever);
}

void Neighbours::measure(int unit) {
  Box& box = box_[idx(unit)];
  box = Box();
  for (const Part& part : parts_[idx(unit)]) {
    const Vector3 centre = pose(part) * part.centreInB;
    centre_[idx(part.geometry)] = centre;
    const double way = wayOf(part, centre);
    way_[idx(part.geometry)] = way;
    box.add(centre, part.radius + way);
  }
  posed_[idx(unit)] = 0;
}

void Neighbours::poseParts(int unit) {
  if (posed_[idx(unit)]) return;
  for (const Part& part : parts_[idx(unit)])
    X_WG_[idx(part.geometry)] = pose(part) * set_.geometry(part.geometry).X_BG;
  posed_[idx(unit)] = 1;
}

void Neighbours::search(int unit) {
  // The part of a unit's size that it may move before its neighbours are looked for again.
  constexpr double kSlack = 0.1;
  ++searches_;
  const Box& box = box_[idx(unit)];
  Box& fat = fat_[idx(unit)];
  const double slack = kSlack * (box.upper - box.lower).norm();
  fat.lower = (box.lower.array() - slack).matrix();
  fat.upper = (box.upper.array() + slack).matrix();
  for (const int other : near_[idx(unit)]) std::erase(near_[idx(other)], unit);
  near_[idx(unit)].clear();
  for (int other = 0; other < units_.size(); ++other) {
    if (other == unit || !fat.overlaps(fat_[idx(other)])) continue;
    near_[idx(unit)].push_back(other);
    std::vector<int>& list = near_[idx(other)];
    list.insert(std::lower_bound(list.begin(), list.end(), unit), unit);
  }
}

const std::vector<Neighbours::Row>& Neighbours::rowsOf(int i, int j) {
  constexpr double kRounding = 1e-9;  // far above that of positions [m]
  const auto [place, isNew] = rows_.try_emplace({std::min(i, j), std::max(i, j)});
  if (!isNew) return place->second;
  for (const Part& one : parts_[idx(i)])
    for (const Part& other : parts_[idx(j)]) {
      const GeometryPair pair = inOrder(set_.model, one.geometry, other.geometry);
      const double margin = pairMaterial(set_.model, pair.a, pair.b).margin;
      const double reach = set_.radius[idx(pair.a)] + set_.radius[idx(pair.b)] + margin + kRounding;
      place->second.push_back({pair.a, pair.b, reach, margin, set_.isPlane(pair.a)});
    }
  return place->second;
}

bool Neighbours::touch(int i, int j) {
  for (const Row& row : rowsOf(i, j)) {
    const Vector3 &a = centre_[idx(row.a)], &b = centre_[idx(row.b)];
    const double way = way_[idx(row.a)] + way_[idx(row.b)], reach = row.reach + way;
    if (!row.plane && !((b - a).squaredNorm() < reach * reach)) continue;
    poseParts(i), poseParts(j);
    const Transform &X_WA = X_WG_[idx(row.a)], &X_WB = X_WG_[idx(row.b)];
    if (row.plane && !(X_WA.R.col(2).dot(b - X_WA.p) < reach)) continue;
    // A pair whose test fails says nothing; within an island it is counted.
    if (set_.test(row.a, X_WA, row.b, X_WB, row.margin + way, test_) && test_.found.count > 0)
      return true;
  }
  return false;
}

void Neighbours::findTouching(const std::vector<int>& awake, const std::vector<int>& groupOf,
                              std::vector<std::pair<int, int>>& touching) noexcept {
  const auto update = [&](int unit) {
    measure(unit);
    if (!parts_[idx(unit)].empty() && !fat_[idx(unit)].contains(box_[idx(unit)])) search(unit);
  };
  for (const int unit : moved_) update(unit);
  moved_.clear();
  for (const int unit : awake) update(unit), awake_[idx(unit)] = 1;
  for (const int unit : awake)
    for (const int other : near_[idx(unit)]) {
      if (groupOf[idx(unit)] == groupOf[idx(other)]) continue;
      // Of two that are awake the first one asks.
      if (other < unit && awake_[idx(other)]) continue;
      if (box_[idx(unit)].overlaps(box_[idx(other)]) && touch(unit, other))
        touching.emplace_back(unit, other);
    }
  for (const int unit : awake) awake_[idx(unit)] = 0;
}

}  // namespace softgauss::collision::detail
