// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/integrators/runge_kutta.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/engine/core/rotation.hpp"
#include "softgauss/engine/step/forward.hpp"
#include "softgauss/engine/step/integrators/stages.hpp"
#include "softgauss/engine/step/integrators/tunnelling.hpp"
#include "softgauss/engine/step/step.hpp"

namespace softgauss {
namespace {

/// φ̇ of (7.5), or v itself where a method is to be as MuJoCo's.
void displacementRate(const Tableau& t, const Model& model, const VectorX& phi, const VectorX& v,
                      VectorX& rate) {
  rate = v;
  if (!t.embedded && model.options.constraintModel == ConstraintModel::mujoco) return;
  for (const Tree& tree : model.trees) {
    const Body& root = model.bodies[tree.rootBody];
    if (root.joint != JointKind::floating) continue;
    const int i = root.v + 3;
    rate.segment<3>(i) = rotationRate(phi.segment<3>(i), v.segment<3>(i));
  }
}

/// k_i at (q₀ ⊕ φ, v): forward dynamics there. False where it is not finite.
bool evaluate(const Tableau& t, const Model& model, ContactSource* contacts, IntegratorStages& s,
              int i, const VectorX& guess, StepStats& stats) {
  Data& data = s.data;
  if (isRefused(computeBodyStages(model, s.input, s.state, data, contacts))) return false;
  forwardDynamics(model, &guess, data);
  if (!countEvaluation(data, stats)) return false;
  s.acceleration[i] = data.forward.a;
  displacementRate(t, model, s.phi, s.state.v, s.rate[i]);
  return true;
}

/// Σ_i c_i k_i, h times.
void combine(double h, const double* c, int count, const std::vector<VectorX>& k, VectorX& sum) {
  sum.setZero();
  for (int i = 0; i < count; ++i)
    if (c[i] != 0.0) sum += (h * c[i]) * k[i];
}

/// One part of the step, of length h, from s.from; its first k is there. The result is in s.state.
/// Returns the largest error over `tolerance`; ∞ where a stage is not finite.
double part(const Tableau& t, const Model& model, ContactSource* contacts, double h,
            double tolerance, IntegratorStages& s, StepStats& stats) {
  for (int i = 1; i <= t.stages; ++i) {
    const bool last = i == t.stages;
    if (last && t.lastIsNext) break;  // the last stage is y⁺
    const double* c = last ? t.b.data() : t.a[i].data();
    combine(h, c, i, s.rate, s.phi);
    combine(h, c, i, s.acceleration, s.state.v);
    s.state.v += s.from.v;
    s.state.q = s.from.q;
    integratePosition(model, s.phi, 1.0, s.state.q);
    if (!s.state.q.allFinite() || !s.state.v.allFinite()) return kInfinity;
    if (!last && !evaluate(t, model, contacts, s, i, s.acceleration[i - 1], stats))
      return kInfinity;
  }
  if (!t.embedded) return 0.0;
  combine(h, t.e.data(), t.stages, s.rate, s.phi);
  double error = s.phi.cwiseAbs().maxCoeff();
  combine(h, t.e.data(), t.stages, s.acceleration, s.phi);
  error = std::max(error, h * s.phi.cwiseAbs().maxCoeff());
  return error / tolerance;
}

}  // namespace

bool rungeKutta(const Tableau& t, const Model& model, const Input& input, ContactSource* contacts,
                Data& data, State& state) noexcept {
  constexpr double kShortest = 1.0 / 512.0;  // of the step
  const double h = model.options.timestep;
  IntegratorStages& s = *data.stages;
  StepStats& stats = data.stats;
  s.begin(input, state);
  s.acceleration[0] = data.forward.a;
  s.phi.setZero();
  displacementRate(t, model, s.phi, state.v, s.rate[0]);
  ++stats.evaluations;

  double done = 0.0, length = h;
  double sight = tunnellingLengthBound(model, data, data.kinematics, contacts, h);
  while (done < h) {
    length = std::min(length, h - done);
    if (t.embedded && length > sight * (1.0 + 1e-9) && !isShortest(length, kShortest * h)) {
      ++stats.tunnellingSplits;
      length = std::max(sight, kShortest * h);
    }
    const bool closes = done + length >= h * (1.0 - 1e-12);
    if (closes) length = h - done;
    const double tolerance = model.options.integrationTolerance * length / h;
    const double deepest = stats.maxPenetration;
    const double error = part(t, model, contacts, length, tolerance, s, stats);
    const bool shortest = !t.embedded || isShortest(length, kShortest * h);
    if (!std::isfinite(error) && shortest) return false;
    const double factor = stepFactor(error, t.order);
    // Looking back from its end: what has grown fast within the part.
    const double seen = shortest || error > 1.0
                            ? length
                            : tunnellingLengthBound(model, data, s.data.kinematics, contacts,
                                                    length, ContactSource::TimeDirection::backward);
    if ((error > 1.0 || seen < length) && !shortest) {
      ++stats.rejections;
      stats.maxPenetration = deepest;  // what was tried has not happened
      length =
          std::max(error > 1.0 ? length * factor : std::min(seen, 0.7 * length), kShortest * h);
      continue;
    }
    stats.minimumStepsAccepted += error > 1.0;
    stats.possibleTunnelling += length > sight * (1.0 + 1e-9);
    ++stats.substeps;
    done = closes ? h : done + length;
    length = std::max(length * factor, kShortest * h);
    s.from.q = s.state.q;
    s.from.v = s.state.v;
    if (done == h) break;
    sight = tunnellingLengthBound(model, data, s.data.kinematics, contacts, h - done);
    // The next part's first k: the last one of this, with φ counted from the new origin.
    s.acceleration[0] = s.acceleration[t.stages - 1];
    s.phi.setZero();
    displacementRate(t, model, s.phi, s.from.v, s.rate[0]);
  }
  data.acceleration = (s.from.v - state.v) / h;
  state.q = s.from.q;
  state.v = s.from.v;
  state.time += h;
  return true;
}

}  // namespace softgauss
