// SPDX-License-Identifier: Apache-2.0
/// Goals are read for an arm and for a humanoid, or refused; those of the arm are followed for a
/// step.

#include "softgauss/io/simulation/scene.hpp"
#include "tests/fuzz/input_folder.hpp"

namespace softgauss::fuzz {
namespace {

std::unique_ptr<Scene> robot(const std::string& name) {
  return loadScene(std::string(SOFTGAUSS_SOURCE_DIR) + "/data/robots/" + name);
}

/// Those that were read; none where they were refused.
io::GoalFile read(const std::string& text, const Scene& scene) {
  try {
    return parseGoals(text, "goals.yaml", scene);
  } catch (const ModelError& error) {
    expectMessage(error.what());
    if (!std::string(error.what()).starts_with("goals.yaml"))
      throw Finding(std::string("names no file: ") + error.what());
  }
  return {};
}

void follow(io::GoalFile goals, Scene& scene) {
  if (goals.goals.empty()) return;
  gdd::GoalDirectedController controller(scene.model);
  std::move(goals).giveTo(controller);
  State state = scene.initial;
  Data data(scene.model);
  const SolveStatus status = controller.step(scene.model, {}, state, data, &scene.source());
  if (!isRefused(status) && !(state.q.allFinite() && state.v.allFinite()))
    throw Finding("a step was taken to a state that is not finite");
}

}  // namespace
}  // namespace softgauss::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace softgauss;
  static const std::unique_ptr<Scene> arm = fuzz::robot("arm.urdf");
  static const std::unique_ptr<Scene> humanoid = fuzz::robot("humanoid.urdf");
  const std::string text(fuzz::textOf(data, size));
  fuzz::read(text, *humanoid);
  fuzz::follow(fuzz::read(text, *arm), *arm);
  return 0;
}
