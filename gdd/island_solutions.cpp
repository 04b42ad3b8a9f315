// SPDX-License-Identifier: Apache-2.0
#include "softgauss/gdd/island_solutions.hpp"

#include <algorithm>

#include "softgauss/engine/core/segment_vectors.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"

namespace softgauss::gdd {

IslandSolutions::IslandSolutions(const Model& model)
    : a(VectorX::Zero(model.nv)), force(a), controlled(model.trees.size(), 1) {
  for (auto* islands : {&islands_, &before_}) islands->reserve(model.trees.size());
  keeps_.reserve(model.trees.size());
  found_.gddA = a;
}

void IslandSolutions::reserve(int breakpoints) {
  for (auto* list : {&warm.breakpoints, &breakpointsBefore_, &found_.breakpoints})
    list->reserve(idx(breakpoints));
}

void IslandSolutions::reset(const Model& model, const State& state, const ControlLimits& limits,
                            Segments dofs) {
  const WarmStart& last = state.warmstart;
  if (last.valid && last.a.size() == model.nv && allFinite(dofs, last.a))
    copy(dofs, last.a, a);
  else
    setZero(dofs, a);
  for (VectorX* x : {&warm.gddA, &warm.multipliers, &warm.control})
    if (x->size() != model.nv) x->setZero(model.nv);
  copy(dofs, a, warm.gddA);
  setZero(dofs, warm.multipliers);
  limits.clamp(dofs, warm.multipliers, force, warm.control);
  warm.gddSearchAge.assign(model.trees.size(), 0);
  warm.gddSearchWait.assign(model.trees.size(), 1);
  controlled.assign(model.trees.size(), 0);
  known.assign(model.trees.size(), 0);
}

void IslandSolutions::begin(const Model& model, const State& state, const ControlLimits& limits,
                            const GoalIslands& islands, const Data& data) {
  const bool again =
      data.parts && data.parts->repeats && !islands.isWhole() && islands.ofTree() == ofTree_;
  if (again) {
    before_ = islands_;
    breakpointsBefore_ = warm.breakpoints;
  }
  islands_.assign(idx(islands.size()), {});
  warm.breakpoints.clear();
  keeps_.assign(idx(islands.size()), again ? 1 : 0);
  ofTree_ = islands.ofTree();
  if (!again) {
    if (!islands.isWhole()) reset(model, state, limits, data.active.dofs());
    return;
  }
  for (const int of : data.active.trees()) {
    const std::size_t t = idx(of);
    const Segment dofs{model.trees[t].firstDof, model.trees[t].dofEnd};
    if (data.parts->mispredicted[t] != 0 || controlled[t] == 0) keeps_[idx(ofTree_[t])] = 0;
    if (controlled[t] == 0) part(a, dofs) = part(state.warmstart.a, dofs);
  }
}

void IslandSolutions::appendBreakpoints(int island, const std::vector<BreakpointKey>& from,
                                        Segment of) {
  Segment& to = islands_[idx(island)].breakpoints;
  to.begin = static_cast<int>(warm.breakpoints.size());
  warm.breakpoints.insert(warm.breakpoints.end(), from.begin() + of.begin, from.begin() + of.end);
  to.end = static_cast<int>(warm.breakpoints.size());
}

GddReport IslandSolutions::keep(int island, Data& data) {
  islands_[idx(island)].report = before_[idx(island)].report;
  appendBreakpoints(island, breakpointsBefore_, before_[idx(island)].breakpoints);
  bool changed = false;
  data.constraints.setResidual(a);
  data.constraints.evaluate(changed);
  return islands_[idx(island)].report.withoutCounts();
}

void IslandSolutions::take(const Model& model, int island, const SequentialQuadraticSolve& solved,
                           const VectorX* residual, const GddReport& report, Data& data) {
  const Segments dofs = data.active.dofs();
  islands_[idx(island)].report = report;
  if (residual)
    for (const Segment s : dofs) part(data.forward.gradient, s) = -part(*residual, s);
  if (data.active.all()) {
    a = solved.acceleration();
    force = solved.force();
    solved.keepWarmStart(warm);
    if (warm.gddSearchAge.empty()) {  // solver 1 does not search
      warm.gddSearchAge.assign(model.trees.size(), 0);
      warm.gddSearchWait.assign(model.trees.size(), 1);
    }
    controlled.assign(model.trees.size(), 1);
    known.assign(model.trees.size(), residual ? 1 : 0);
    return;
  }
  solved.keepWarmStart(data.active, found_);
  copy(dofs, solved.acceleration(), a);
  copy(dofs, solved.force(), force);
  copy(dofs, found_.gddA, warm.gddA);
  copy(dofs, found_.control, warm.control);
  appendBreakpoints(island, found_.breakpoints, {0, static_cast<int>(found_.breakpoints.size())});
  for (const int of : data.active.trees()) {
    const std::size_t t = idx(of);
    controlled[t] = 1;
    known[t] = residual ? 1 : 0;
    warm.gddSearchAge[t] = found_.gddSearchAge[t];
    warm.gddSearchWait[t] = found_.gddSearchWait[t];
  }
}

}  // namespace softgauss::gdd
