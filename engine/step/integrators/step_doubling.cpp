// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/step_doubling.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/integrators/single_solve.hpp"
#include "softgauss/engine/step/integrators/stages.hpp"
#include "softgauss/engine/step/integrators/tunnelling.hpp"
#include "softgauss/engine/step/step.hpp"

namespace softgauss {
namespace {

/// One whole step of length h on the part's model. False where it is not finite.
bool take(double h, ContactSource* contacts, IntegratorStages& s, State& state, StepStats& stats) {
  Model& model = *s.part;
  model.options.timestep = h;
  if (s.data.plan.drifts) driftBefore(model, s.data, state);
  if (isRefused(computeBodyStages(model, s.input, state, s.data, contacts))) return false;
  forwardDynamics(model, state, s.data);
  if (!countEvaluation(s.data, stats)) return false;
  if (!moveOnce(model, s.data, state)) return false;
  state.warmstart.a = s.data.forward.a;
  state.warmstart.valid = true;
  return true;
}

}  // namespace

bool stepDoubling(const Model& model, const Input& input, ContactSource* contacts,
                  const State& start, Data& data, State& state) noexcept {
  constexpr double kShortest = 1.0 / 512.0;  // of the step
  const double h = model.options.timestep;
  IntegratorStages& s = *data.stages;
  StepStats& stats = data.stats;
  s.begin(input, start);
  s.from.a = state.a;
  s.from.hasAcceleration = state.hasAcceleration;
  const int order = data.plan.drifts ? 2 : 1;
  ++stats.evaluations;

  double done = 0.0, length = h;
  bool first = true;  // its solve is the step's own
  double sight = tunnellingLengthBound(model, data, data.kinematics, contacts, h);
  while (done < h) {
    length = std::min(length, h - done);
    if (length > sight * (1.0 + 1e-9) && !isShortest(length, kShortest * h)) {
      ++stats.tunnellingSplits;
      length = std::max(sight, kShortest * h);
      first = first && length == h;
    }
    const bool closes = done + length >= h * (1.0 - 1e-12);
    if (closes) length = h - done;
    const double deepest = stats.maxPenetration;
    s.end = first ? state : s.from;
    bool finite = first ? moveOnce(model, data, s.end) : take(length, contacts, s, s.end, stats);
    first = false;
    s.state = s.from;
    for (int half = 0; half < 2; ++half)
      finite = finite && take(0.5 * length, contacts, s, s.state, stats);
    double error = kInfinity;
    if (finite) {
      positionDifference(model, s.end.q, s.state.q, s.phi);
      error = std::max(s.phi.cwiseAbs().maxCoeff(),
                       length * (s.state.v - s.end.v).cwiseAbs().maxCoeff());
    }
    const double ratio = error * h / (length * model.options.integrationTolerance);
    const bool shortest = isShortest(length, kShortest * h);
    if (!std::isfinite(ratio) && shortest) return false;
    const double factor = stepFactor(ratio, order);
    if (ratio > 1.0 && !shortest) {
      ++stats.rejections;
      stats.maxPenetration = deepest;  // what was tried has not happened
      length = std::max(length * factor, kShortest * h);
      continue;
    }
    stats.minimumStepsAccepted += ratio > 1.0;
    stats.possibleTunnelling += length > sight * (1.0 + 1e-9);
    ++stats.substeps;
    done = closes ? h : done + length;
    length = std::max(length * factor, kShortest * h);
    s.from = s.state;
    if (done < h && looksForContacts(data, contacts)) {
      computeKinematics(model, s.from, s.kinematics);
      sight = tunnellingLengthBound(model, data, s.kinematics, contacts, h - done);
    }
  }
  data.acceleration = (s.from.v - start.v) / h;
  state.q = s.from.q;
  state.v = s.from.v;
  state.a = s.from.a;
  state.hasAcceleration = s.from.hasAcceleration;
  state.connectionForces = s.from.connectionForces;
  state.time += h;
  return true;
}

}  // namespace softgauss
