// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/batch_race.hpp"

#include <algorithm>

#include "apps/compare_mujoco/mjcf.hpp"
#include "apps/compare_mujoco/mujoco.hpp"
#include "apps/shared/cpu_time.hpp"
#include "softgauss/gdd/planning/plan_search.hpp"
#include "softgauss/io/simulation/rollout.hpp"

namespace softgauss::app {

RaceTimes raceBatch(const std::filesystem::path& robot, const BatchChoice& choice) {
  const auto scene = loadScene(robot);
  const Model& model = scene->model;
  const auto nv = static_cast<std::size_t>(model.nv);
  planning::NormalNumbers random(1);
  std::vector<double> v0(static_cast<std::size_t>(choice.runs) * nv);
  for (double& v : v0) v = 0.1 * random.next();
  std::vector<double> q(static_cast<std::size_t>(choice.runs * choice.steps * model.nq));
  Rollout rollout(*scene, {}, 1);
  RolloutInputs in{.runs = choice.runs, .steps = choice.steps};
  in.v0 = v0;
  RolloutOutputs out;
  out.q = q;
  Mujoco mujoco(Mujoco::withRoom(mjcfOf(model, scene->contacts->filter())));
  const VectorX none = VectorX::Zero(model.nv);
  const auto loop = [&] {
    State state = scene->initial;
    for (std::size_t run = 0; run < static_cast<std::size_t>(choice.runs); ++run) {
      std::copy_n(v0.data() + run * nv, nv, state.v.data());
      mujoco.set(state, none);
      mujoco.setWarmStart(none);
      for (int i = 0; i < choice.steps; ++i) mujoco.step();
    }
  };
  const auto timed = [&](auto&& all) {
    const double start = cpuSeconds();
    all();
    return 1e6 * (cpuSeconds() - start) / (choice.runs * choice.steps);
  };
  RaceTimes best{kInfinity, kInfinity};
  for (int round = 0; round < choice.rounds; ++round) {
    best.ours = std::min(best.ours, timed([&] { rollout.run(in, out); }));
    best.mujoco = std::min(best.mujoco, timed(loop));
  }
  return best;
}

}  // namespace softgauss::app
