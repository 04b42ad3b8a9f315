// SPDX-License-Identifier: Apache-2.0
#include "apps/control_latency/loops.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <random>

#include "softgauss/io/simulation/simulation.hpp"

namespace softgauss::app {
namespace {

/// A loop, and what disturbs it: seconds until it begins anew, pushes of a link.
struct Loop {
  const char* name;
  const char* file;
  void (*setGoals)(Simulation&);
  double length = 3.0;      ///< [s]
  const char* pushed = "";  ///< a link
  double force = 0.0;       ///< [N], of a push of a tenth of a second every second
  double disturbed = 0.0;   ///< joints at the start [rad]
};

void reachAndStand(Simulation& sim) {
  sim.goals.reach("right_hand", {0.45, -0.25, 1.1});
  sim.goals.posture(1000.0);
}

const Loop kLoops[] = {
    {"arm", "data/robots/arm.urdf",
     [](Simulation& sim) {
       sim.goals.reach("hand", {0.5, 0.3, 0.5});
     },
     3.0, "hand", 30.0, 0.3},
    {"humanoid", "data/robots/humanoid.urdf", reachAndStand, 3.0, "", 0.0, 0.02},
    {"humanoid_pushed", "data/robots/humanoid.urdf", reachAndStand, 3.0, "torso", 60.0, 0.02},
    {"humanoid_falls", "data/robots/humanoid.urdf",
     [](Simulation& sim) { sim.goals.posture(1000.0); }, 4.0, "torso", 400.0, 0.1},
    {"hand", "data/robots/hand.urdf",
     [](Simulation& sim) {
       sim.goals.reach("index_tip", {0.25, 0.08, 0.06});
     },
     3.0, "", 0.0, 0.1},
    {"hand_and_ball", "data/scenes/hand_and_ball.yaml", [](Simulation&) {}, 3.0, "ball", 1.0, 0.0},
    {"humanoid_at_wall", "data/scenes/humanoid_pushes_wall.yaml", [](Simulation&) {}, 4.0, "", 0.0,
     0.02},
};

/// Pushes the link for a tenth of a second every second, each time another way.
void push(const Loop& loop, Simulation& sim, std::mt19937& random) {
  Input& input = sim.input();
  const double phase = std::fmod(sim.time(), 1.0);
  if (phase >= 0.6) input.wrenches.clear();
  if (loop.force == 0.0 || phase < 0.5 || phase >= 0.6 || !input.wrenches.empty()) return;
  std::uniform_real_distribution<double> angle(0.0, 6.283185307179586);
  const double a = angle(random);
  const int frame = sim.model().findFrame(loop.pushed);
  if (frame < 0) throw NameError(std::string("no link '") + loop.pushed + "'");
  const int body = sim.model().frames[static_cast<std::size_t>(frame)].body;
  input.wrenches.push_back(
      {body, {Vector3::Zero(), loop.force * Vector3(std::cos(a), std::sin(a), 0.0)}});
}

/// Another start, within the joints' ranges.
void begin(const Loop& loop, Simulation& sim, std::mt19937& random) {
  sim.reset();
  sim.input().wrenches.clear();
  std::uniform_real_distribution<double> by(-loop.disturbed, loop.disturbed);
  for (const JointRange& range : sim.model().ranges) {
    double& q = sim.state().q[sim.model().bodies[static_cast<std::size_t>(range.body)].q];
    q = std::clamp(q + by(random), range.lower, range.upper);
  }
}

}  // namespace

std::vector<std::string> loopNames() {
  std::vector<std::string> names;
  for (const Loop& loop : kLoops) names.emplace_back(loop.name);
  return names;
}

LoopTimes runLoop(const std::string& name, const std::string& folder,
                  const SimulationOptions& options, int cycles,
                  const std::function<long()>& count) {
  using Clock = std::chrono::steady_clock;
  const Loop& loop = *std::find_if(std::begin(kLoops), std::end(kLoops),
                                   [&](const Loop& l) { return l.name == name; });
  Simulation sim = Simulation::load(folder + "/" + loop.file, options);
  loop.setGoals(sim);
  sim.reserve();
  std::mt19937 random(1);
  LoopTimes times;
  times.us.reserve(static_cast<std::size_t>(cycles));
  VectorX q = sim.state().q, v = sim.state().v;
  for (int i = 0; i < cycles; ++i) {
    if (i == 0 || sim.time() >= loop.length) begin(loop, sim, random);
    push(loop, sim, random);
    q = sim.state().q;
    v = sim.state().v;
    const long before = count();
    const Clock::time_point start = Clock::now();
    const ControlSolution& answer = sim.solve(q, v);
    times.us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
    using gdd::GddStatus;
    const GddStatus status = answer.report.status;
    times.budgetMet += status == GddStatus::iterationLimit;
    times.uncertified += status != GddStatus::iterationLimit && status != GddStatus::converged &&
                         status != GddStatus::nonsmoothMinimum;
    if (isRefused(answer.status) || isRefused(sim.step())) throw StepError(sim.failure());
    times.counted += count() - before;
  }
  return times;
}

}  // namespace softgauss::app
