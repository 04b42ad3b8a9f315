// SPDX-License-Identifier: Apache-2.0
/// A scene is loaded with its goals, or refused; what loads takes steps.

#include "softgauss/io/simulation/scene.hpp"
#include "tests/fuzz/input_folder.hpp"
#include "tests/random_scenes/step_laws.hpp"

namespace softgauss::fuzz {
namespace {

constexpr int kSteps = 2;
constexpr int kMostDofs = 40;  // of what is stepped: time is for files

/// The files that scenes of the tree name, where those find them.
struct Folder : InputFolder {
  Folder() {
    link("robots", "data/robots");
    link("robot.urdf", "tests/bad_input/files/robot.urdf");
    link("world_root.urdf", "tests/bad_input/files/world_root.urdf");
    link("heights", "tests/bad_input/files/heights");
    link("scenes/hills.csv", "data/scenes/hills.csv");
    const std::string hard = "data/scenes/stability";
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(SOFTGAUSS_SOURCE_DIR) + "/" + hard))
      if (const auto name = entry.path().filename(); name.extension() == ".urdf")
        link("scenes/" + name.string(), hard + "/" + name.string());
  }
};

void load(const std::filesystem::path& file) {
  try {
    const std::unique_ptr<Scene> scene = loadScene(file);
    gdd::GoalDirectedController controller(scene->model);
    setUpControl(*scene, {}, controller);
    if (scene->model.nv == 0 || scene->model.nv > kMostDofs) return;
    Run run(scene->model, scene->initial, &scene->source());
    run.steps({}, kSteps);
  } catch (const ModelError& error) {
    expectMessage(error.what());
  } catch (const OptionError& error) {
    expectMessage(error.what());
  }
}

}  // namespace
}  // namespace softgauss::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace softgauss::fuzz;
  static const Folder folder;
  load(folder.write("scenes/scene.yaml", textOf(data, size)));
  return 0;
}
