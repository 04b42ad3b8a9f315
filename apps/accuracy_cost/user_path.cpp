// SPDX-License-Identifier: Apache-2.0
#include "apps/accuracy_cost/user_path.hpp"

#include <fmt/format.h>

#include <fstream>

#include "apps/simulate_gdd/accuracy.hpp"

namespace softgauss::app {
namespace {

/// τ of the problem as rows of controls, one for each period.
void writeTable(const std::filesystem::path& file, const Problem& problem, const Model& model) {
  std::ofstream out(file);
  std::vector<int> dofs;
  out << "time_s";
  for (int body = 1; body < model.bodyCount(); ++body) {
    const Body& b = model.bodies[static_cast<std::size_t>(body)];
    if (b.dofs != 1 || !model.dofs[static_cast<std::size_t>(b.v)].actuated) continue;
    out << ",u:" << model.jointNames[static_cast<std::size_t>(body)];
    dofs.push_back(b.v);
  }
  VectorX tau = VectorX::Zero(model.nv);
  for (int k = 0; k < problem.windowPeriods; ++k) {
    problem.force(model, k * kPeriod, tau);
    out << fmt::format("\n{}", k * kPeriod);
    for (const int dof : dofs) out << fmt::format(",{}", tau[dof]);
  }
  out << "\n";
}

}  // namespace

UserChoice chooseAsUser(const Problem& problem, double accuracy,
                        const std::filesystem::path& folder) {
  Scene scene;
  scene.model = problem.build().build();
  scene.initial = State(scene.model);
  if (problem.start) problem.start(scene.model, scene.initial);
  SimulateOptions options;
  options.duration = problem.windowPeriods * kPeriod;
  options.accuracy = accuracy;
  options.quiet = true;
  if (problem.force) {
    options.torques = folder / (problem.name + "_torques.csv");
    writeTable(options.torques, problem, scene.model);
  } else {
    options.passive = true;
  }

  UserChoice choice;
  try {
    choice.told = chooseAccuracy(options, scene);
  } catch (const AccuracyError& error) {
    choice.told = error.what();
    return choice;
  }
  const Options& o = scene.model.options;
  choice.found = true;
  choice.h = o.timestep;
  choice.method = {"softgauss", std::string(integratorName(o.integrator)), "of simulate_gdd"};
  choice.method.tolerance = o.tolerance;
  choice.method.doubling = o.stepDoubling;
  if (o.stepDoubling || o.integrator == Integrator::dormandPrince)
    choice.method.integrationTolerance = o.integrationTolerance;
  return choice;
}

}  // namespace softgauss::app
