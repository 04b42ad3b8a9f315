// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A description of a robot is loaded, with all that simulate_gdd makes of it, or refused; what
/// loads takes steps.

#include "softgauss/io/simulation/scene.hpp"
#include "tests/fuzz/input_folder.hpp"
#include "tests/random_scenes/step_laws.hpp"

namespace softgauss::fuzz {

inline void loadModelFile(const std::filesystem::path& file) {
  constexpr int kSteps = 3;
  constexpr int kMostDofs = 60;  // of what is stepped: time is for files
  try {
    const std::unique_ptr<Scene> scene = loadScene(file);
    if (scene->model.nv == 0 || scene->model.nv > kMostDofs) return;
    Run run(scene->model, scene->initial, &scene->source());
    run.steps({}, kSteps);
  } catch (const ModelError& error) {
    expectMessage(error.what());
    if (!std::string(error.what()).starts_with(file.string()))
      throw Finding(std::string("names no file: ") + error.what());
  } catch (const OptionError& error) {
    expectMessage(error.what());
  }
}

}  // namespace softgauss::fuzz
