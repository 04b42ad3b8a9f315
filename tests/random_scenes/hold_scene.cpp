// SPDX-License-Identifier: Apache-2.0
#include "tests/random_scenes/hold_scene.hpp"

#include <algorithm>
#include <cmath>

#include "softgauss/collision/scene_contacts.hpp"
#include "tests/random_scenes/finding.hpp"
#include "tests/random_scenes/step_laws.hpp"

namespace softgauss::fuzz {
namespace {

/// Error control may divide each step into many.
int stepsOf(const Options& options) {
  if (!options.isMultiStage()) return 12;
  return options.integrator == Integrator::dormandPrince || options.stepDoubling ? 1 : 3;
}

/// Nothing is stored at the start that could come out: no overlap, no joint beyond its range.
bool startsFree(const SmallScene& scene, const Data& data) {
  for (const JointRange& range : scene.model.ranges) {
    const double q = scene.state.q[scene.model.bodies[range.body].q];
    if (!(q - range.lower > range.margin && range.upper - q > range.margin)) return false;
  }
  for (const Contact& contact : data.contacts.contacts) {
    const Geometry& a = scene.model.geometries[static_cast<std::size_t>(contact.geometryA)];
    const Geometry& b = scene.model.geometries[static_cast<std::size_t>(contact.geometryB)];
    if (contact.distance < std::max(a.material.margin, b.material.margin)) return false;
  }
  return true;
}

/// The most energy over that of the start, and the bound of it.
class EnergyWatch {
 public:
  explicit EnergyWatch(const Model& model) : model_(model), kinematics_(model) {}

  void observe(const State& state, const StepStats* stats) {
    computeKinematics(model_, state, kinematics_);
    const Energy energy = computeEnergy(model_, kinematics_, state.q, state.v);
    if (!stats) start_ = energy.total();
    most_ = std::max(most_, energy.total());
    kinetic_ = std::max(kinetic_, energy.kinetic);
    potential_ = std::max(potential_, std::abs(energy.potential));
    smooth_ = smooth_ && !(stats && stats->rows > 0);
    resolved_ = resolved_ && !(stats && stats->minimumStepsAccepted > 0);
  }

  /// Of motion that the step has resolved: where it has not, it counts that itself. Of the midpoint
  /// rule smooth motion alone, which it promises: it has let dry friction drive a light link.
  void judge() const {
    const bool midpoint = model_.options.integrator == Integrator::implicitMidpoint;
    if (!resolved_ || (midpoint && !smooth_)) return;
    const double gain = most_ - start_;
    if (gain > bound())
      throw Finding("a passive scene gains " + std::to_string(gain) + " J, expected at most " +
                    std::to_string(bound()));
  }

 private:
  /// The midpoint rule closes the balance of smooth motion to what its sweeps leave, 1e-10 of the
  /// energies; ten times that for sums of twelve steps. Else what simulate_gdd would tell: 5 % of
  /// the largest kinetic energy, and what lifts all that moves by 1 mm.
  double bound() const {
    if (model_.options.integrator == Integrator::implicitMidpoint)
      return 1e-9 * (kinetic_ + potential_) + 1e-12;
    return 0.05 * kinetic_ +
           std::max(1e-3 * model_.totalMass() * model_.options.gravity.norm(), 1e-9);
  }

  const Model& model_;
  Kinematics kinematics_;
  double start_ = 0.0, most_ = -kInfinity, kinetic_ = 0.0, potential_ = 0.0;
  bool smooth_ = true, resolved_ = true;
};

/// The bound is one of steps that resolve the motion: default time steps, turns within one that a
/// leapfrog does not divide, and rules that follow them. Those of order 1 gain energy where bodies
/// turn, and the damping of runge-kutta-4 is explicit.
bool resolves(const SmallScene& scene) {
  const Options& o = scene.model.options;
  constexpr double kDefaultTimestep = 0.002;
  const bool follows = o.integrator == Integrator::leapfrog ||
                       o.integrator == Integrator::implicitMidpoint ||
                       o.integrator == Integrator::dormandPrince;
  return follows && o.constraintModel == ConstraintModel::softgauss &&
         o.timestep <= kDefaultTimestep &&
         scene.state.v.cwiseAbs().maxCoeff() * o.timestep < o.substepAngle;
}

}  // namespace

void holdScene(const SmallScene& scene) {
  collision::SceneContacts contacts(scene.model);
  const int steps = stepsOf(scene.model.options);
  Run first(scene.model, scene.state, &contacts);
  EnergyWatch watch(scene.model);
  if (scene.state.q.allFinite()) watch.observe(scene.state, nullptr);
  bool free = scene.passive && resolves(scene), refused = false;
  for (int i = 0; i < steps && !refused; ++i) {
    refused = isRefused(first.steps(scene.input, 1));
    if (refused) break;
    if (i == 0) free = free && startsFree(scene, first.data());
    watch.observe(first.state(), &first.data().stats);
  }
  if (free && !refused) watch.judge();

  collision::SceneContacts anew(scene.model);
  Run again(scene.model, scene.state, &anew);
  again.steps(scene.input, steps);
  if (bytesOf(first.state()) != bytesOf(again.state()))
    throw Finding("a repeated run has other bits");
}

}  // namespace softgauss::fuzz
