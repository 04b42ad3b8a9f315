// SPDX-License-Identifier: Apache-2.0
#include "apps/compare_mujoco/step_duel.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <fstream>

#include "apps/compare_mujoco/mjcf.hpp"
#include "apps/compare_mujoco/mujoco.hpp"
#include "apps/shared/cpu_time.hpp"
#include "softgauss/collision/scene_contacts.hpp"
#include "softgauss/io/simulation/time_grid.hpp"

namespace softgauss::app {

StepTimes timeSteps(const Model& model, const State& initial, double duration, int rounds,
                    const std::function<VectorX(double)>& control) {
  const double h = model.options.timestep;
  const auto steps = static_cast<int>(stepsIn(duration, h));
  std::vector<VectorX> forces;
  for (int i = 0; i < steps; ++i) forces.push_back(control(i * h));
  collision::SceneContacts contacts(model);
  Data data(model);
  Mujoco mujoco(mjcfOf(model, contacts.filter()));
  StepTimes best{kInfinity, kInfinity};
  Input input;
  const auto ours = [&] {
    State state = initial;
    const double start = cpuSeconds();
    for (const VectorX& tau : forces) {
      input.tau = tau;
      if (isRefused(step(model, input, state, data, &contacts)))
        throw NotFinite(fmt::format(
            "our simulation became non-finite at t = {:.6g} s; try a smaller --timestep",
            state.time));
    }
    return cpuSeconds() - start;
  };
  const auto theirs = [&] {
    mujoco.set(initial, forces.front());
    mujoco.setWarmStart(VectorX::Zero(model.nv));
    const double start = cpuSeconds();
    for (const VectorX& tau : forces) {
      mujoco.setForce(tau);
      mujoco.step();
    }
    return cpuSeconds() - start;
  };
  for (int round = 0; round < rounds; ++round) {
    best.ours = std::min(best.ours, 1e6 * ours() / steps);
    best.mujoco = std::min(best.mujoco, 1e6 * theirs() / steps);
  }
  return best;
}

std::string mujocoBuild() {
  std::string built = "unknown";
  Dl_info info;
  if (dladdr(reinterpret_cast<const void*>(&mj_step), &info) && info.dli_fname) {
    std::ifstream file(info.dli_fname, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    for (const char* mark : {"clang version", "GCC: ("}) {
      const std::size_t found = bytes.find(mark);
      if (found == std::string::npos) continue;
      built = bytes.substr(found, bytes.find('\0', found) - found);
      break;
    }
  }
  return fmt::format("MuJoCo {}, built with {}", mj_versionString(), built);
}

}  // namespace softgauss::app
