// SPDX-License-Identifier: Apache-2.0
#include "apps/stability_report/outcome.hpp"

#include <cmath>

#include "softgauss/io/scene.hpp"

namespace softgauss::app {

Model loadCase(const std::filesystem::path& scenes, const HardCase& hard, double timestep,
               State& state, const MechanismSet& mechanisms) {
  io::SceneFile file = io::readScene(scenes / (hard.scene + ".yaml"));
  file.builder.options.timestep = timestep;
  file.builder.options.mechanisms = mechanisms;
  Model model = file.builder.build();
  state = file.initialState(model);
  return model;
}

int stepsOf(const HardCase& hard, double timestep) {
  return static_cast<int>(std::round(hard.duration / timestep));
}

Outcome runCase(Stage& stage, const HardCase& hard, const std::function<bool()>& advance) {
  constexpr double kFastest = 1e6;  // [m/s or rad/s] beyond, a run counts as diverged
  Outcome outcome;
  outcome.ran = true;
  std::vector<double> starts;
  for (const Figure& f : hard.figures) starts.push_back(f.start ? f.start(stage) : 0.0);
  outcome.figures.assign(hard.figures.size(), 0.0);
  outcome.courses.resize(hard.figures.size());
  const double h = stage.model.options.timestep;
  for (int i = 1; i <= stepsOf(hard, h); ++i) {
    if (!advance() || !stage.state.q.allFinite() ||
        !(stage.state.v.cwiseAbs().maxCoeff() < kFastest)) {
      outcome.diverged = i * h;
      return outcome;
    }
    for (std::size_t f = 0; f < hard.figures.size(); ++f) {
      const Figure& figure = hard.figures[f];
      const double value = figure.scale * figure.value(stage, starts[f]);
      double& kept = outcome.figures[f];
      if (figure.of == Figure::last || std::abs(value) > std::abs(kept)) kept = value;
      outcome.courses[f].push_back(value);
    }
  }
  return outcome;
}

Outcome runOurs(const std::filesystem::path& scenes, const HardCase& hard, double timestep,
                const MechanismSet& mechanisms) {
  State initial;
  Stage stage(loadCase(scenes, hard, timestep, initial, mechanisms));
  stage.state = initial;
  collision::SceneContacts contacts(stage.model);
  Data data(stage.model);
  const Input input;
  return runCase(stage, hard, [&] {
    return !isRefused(step(stage.model, input, stage.state, data, &contacts));
  });
}

}  // namespace softgauss::app
