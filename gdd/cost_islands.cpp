// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/cost.hpp"

/// The cost as a sum over islands.

namespace softgauss::gdd {
namespace {

/// f(body), a body that each contact moves of which the forces have a price.
template <class F>
void visitContacts(const ContactForceCost& forces, const Constraints& rows, F&& f) {
  rows.visitContacts([&](const auto& contacts) {
    for (const ContactForceCost::Part& part : forces.parts())
      if (part.cone == contacts.kCone) f(contacts.jacobian().bodyOf(part.contact));
  });
}

}  // namespace

void GoalCost::appendPairs(const Model& model, const Constraints& rows,
                           std::vector<std::pair<int, int>>& pairs) const {
  for (std::size_t i = 0; i < denseWeight_.size(); ++i)
    appendCoupledTrees(model, dense_.col(static_cast<Eigen::Index>(i)), pairs);
  controlCost_.appendPairs(model, pairs);
  int first = 0;
  visitContacts(forces_, rows, [&](int body) {
    if (first != 0) pairs.emplace_back(first, body);
    first = body;
  });
  if (!hasFunctions()) return;
  for (const Tree& tree : model.trees)
    pairs.emplace_back(model.trees.front().rootBody, tree.rootBody);
}

void GoalCost::divide(const Model& model, const Constraints& rows, const TreeIslands& islands) {
  islands_ = &islands;
  for (SegmentSets* sets : {&points_, &denseRows_}) sets->reserve(model.trees.size(), 0);
  const auto islandOf = [&](int body) { return islands.ofBody()[idx(body)]; };
  points_.divide({0, rows_.size()}, islands.size(),
                 [&](int block) { return islandOf(rows_.bodyOf(block)); });
  denseRows_.divide({0, static_cast<int>(denseWeight_.size())}, islands.size(), [&](int row) {
    for (const Tree& tree : model.trees)
      if (islandOf(tree.rootBody) >= 0 && moves(tree, dense_.col(row)))
        return islandOf(tree.rootBody);
    return -1;  // of no dof of who is awake
  });
  forcesIsland_ = -1;
  visitContacts(forces_, rows, [&](int body) { forcesIsland_ = islandOf(body); });
}

void GoalCost::select(int island) {
  island_ = island;
  forcesCount_ = island < 0 || island == forcesIsland_;
}

}  // namespace softgauss::gdd
