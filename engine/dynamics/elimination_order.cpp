// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/dynamics/elimination_order.hpp"

#include <algorithm>

#include "softgauss/engine/core/check.hpp"

namespace softgauss {

EliminationOrder::EliminationOrder(const Model& model)
    : parent_(model.bodies.size()),
      place_(model.bodies.size()),
      later_(model.bodies.size()),
      neighbours_(model.bodies.size()) {
  constexpr std::size_t kFew = 64;  // bodies whose lists are little memory
  parts_.reserve(model.trees.size() + 1);
  islandOf_.reserve(model.bodies.size());
  for (int b = 1; b < model.bodyCount(); ++b) parent_[idx(b)] = model.bodies[idx(b)].parent;
  for (std::size_t b = 0; b < model.bodies.size() && model.bodies.size() <= kFew; ++b) {
    later_[b].reserve(model.bodies.size());
    neighbours_[b].reserve(model.bodies.size());
  }
}

int EliminationOrder::block(int earlier, int later) const {
  for (const Coupling& c : later_[idx(earlier)])
    if (c.body == later) return c.block;
  SOFTGAUSS_ASSERT(false);
  return -1;
}

void EliminationOrder::find(std::vector<std::pair<int, int>>& pairs, const TreeIslands* islands) {
  const std::span<const int> given = islands ? islands->ofBody() : std::span<const int>();
  const auto islandOf = [&](int body) { return islands ? given[idx(body)] : 0; };
  for (auto& [a, b] : pairs)
    if (a > b) std::swap(a, b);
  std::sort(pairs.begin(), pairs.end(), [&](const auto& x, const auto& y) {
    const int a = islandOf(x.first), b = islandOf(y.first);
    return a != b ? a < b : x < y;
  });
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  if (found_ && pairs == pairs_ && std::ranges::equal(given, islandOf_)) return;
  found_ = true;
  pairs_.assign(pairs.begin(), pairs.end());
  islandOf_.assign(given.begin(), given.end());
  blocks_ = 0;
  parts_.clear(), steps_.clear(), couplings_.clear(), pairBlocks_.clear(), passings_.clear();
  for (auto& coupled : later_) coupled.clear();
  children_.assign(parent_.size(), 0);
  for (std::size_t b = 1; b < parent_.size(); ++b) ++children_[idx(parent_[b])];
  if (!islands) {
    const Segment all{1, static_cast<int>(parent_.size())};
    return findPart({&all, 1}, {0, static_cast<int>(pairs_.size())});
  }
  Segment of;
  for (int island = 0; island < islands->size(); ++island, of.begin = of.end) {
    while (idx(of.end) < pairs_.size() && islandOf(pairs_[idx(of.end)].first) == island) ++of.end;
    findPart(islands->bodies(island), of);
  }
}

void EliminationOrder::findPart(Segments bodies, Segment pairs) {
  Part part{{static_cast<int>(steps_.size()), 0}, {blocks_, 0}};
  findSequence(bodies, pairs);
  for (std::size_t i = 0; i < sequence_.size(); ++i)
    place_[idx(sequence_[i])] = static_cast<int>(i);
  for (int i = pairs.begin; i < pairs.end; ++i)
    addBlock(pairs_[idx(i)].first, pairs_[idx(i)].second);
  for (const int body : sequence_) addStep(body);
  part.steps.end = static_cast<int>(steps_.size());
  part.blocks.end = blocks_;
  parts_.push_back(part);
}

void EliminationOrder::findSequence(Segments bodies, Segment pairs) {
  sequence_.clear();
  // A child has a larger number than its parent.
  const auto leavesFirst = [&](auto&& f) {
    for (auto s = bodies.rbegin(); s != bodies.rend(); ++s)
      for (int b = s->end - 1; b >= s->begin; --b) f(b);
  };
  if (pairs.begin == pairs.end) return leavesFirst([&](int b) { sequence_.push_back(b); });
  ready_.clear();
  leavesFirst([&](int b) {
    neighbours_[idx(b)].clear();
    if (children_[idx(b)] == 0) ready_.push_back(b);
  });
  for (int i = pairs.begin; i < pairs.end; ++i) {
    const auto& [a, b] = pairs_[idx(i)];
    neighbours_[idx(a)].push_back(b);
    neighbours_[idx(b)].push_back(a);
  }
  while (!ready_.empty()) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < ready_.size() && !neighbours_[idx(ready_[best])].empty(); ++i)
      if (neighbours_[idx(ready_[i])].size() < neighbours_[idx(ready_[best])].size()) best = i;
    const int body = ready_[best];
    ready_[best] = ready_.back();
    ready_.pop_back();
    eliminate(body);
  }
}

/// Takes a body off the graph; its neighbours and its parent become neighbours of each other.
void EliminationOrder::eliminate(int body) {
  sequence_.push_back(body);
  const int parent = parent_[idx(body)];
  around_.assign(neighbours_[idx(body)].begin(), neighbours_[idx(body)].end());
  for (const int near : around_) {
    std::vector<int>& others = neighbours_[idx(near)];
    others.erase(std::find(others.begin(), others.end(), body));
  }
  if (parent != 0 && !around_.empty() &&
      std::find(around_.begin(), around_.end(), parent) == around_.end())
    around_.push_back(parent);
  for (std::size_t i = 0; i < around_.size(); ++i)
    for (std::size_t j = i + 1; j < around_.size(); ++j) connect(around_[i], around_[j]);
  if (parent != 0 && --children_[idx(parent)] == 0) ready_.push_back(parent);
}

void EliminationOrder::connect(int a, int b) {
  std::vector<int>& others = neighbours_[idx(a)];
  if (std::find(others.begin(), others.end(), b) != others.end()) return;
  others.push_back(b);
  neighbours_[idx(b)].push_back(a);
}

int EliminationOrder::addBlock(int a, int b) {
  if (!isBefore(a, b)) std::swap(a, b);
  for (const Coupling& c : later_[idx(a)])
    if (c.body == b) return c.block;
  later_[idx(a)].push_back({b, blocks_});
  return blocks_++;
}

void EliminationOrder::addStep(int body) {
  const std::vector<Coupling>& later = later_[idx(body)];
  Step step;
  step.body = body;
  step.coupling = static_cast<int>(couplings_.size());
  step.couplings = static_cast<int>(later.size());
  step.pair = static_cast<int>(pairBlocks_.size());
  step.passing = static_cast<int>(passings_.size());
  couplings_.insert(couplings_.end(), later.begin(), later.end());
  std::sort(couplings_.end() - step.couplings, couplings_.end(),
            [&](const Coupling& a, const Coupling& b) { return isBefore(a.body, b.body); });
  const int end = step.coupling + step.couplings;
  for (int i = step.coupling; i < end; ++i)
    for (int j = i + 1; j < end; ++j)
      pairBlocks_.push_back(addBlock(couplings_[idx(i)].body, couplings_[idx(j)].body));
  const int parent = parent_[idx(body)];
  for (int i = step.coupling; i < end && parent != 0; ++i) {
    const Coupling c = couplings_[idx(i)];
    using To = Passing::To;
    if (c.body == parent)
      passings_.push_back({c.block, To::inertia, parent});
    else
      passings_.push_back({c.block, isBefore(parent, c.body) ? To::block : To::transposedBlock,
                           addBlock(parent, c.body)});
  }
  step.passingEnd = static_cast<int>(passings_.size());
  steps_.push_back(step);
}

}  // namespace softgauss
