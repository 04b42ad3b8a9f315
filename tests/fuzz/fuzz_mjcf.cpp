// SPDX-License-Identifier: Apache-2.0
/// An MJCF is loaded, with all that simulate_gdd makes of it, or refused; what loads takes steps.

#include "softgauss/io/simulation/scene.hpp"
#include "tests/fuzz/input_folder.hpp"
#include "tests/random_scenes/step_laws.hpp"

namespace softgauss::fuzz {
namespace {

constexpr int kMjcfSteps = 3;
constexpr int kMostMjcfDofs = 60;  // of what is stepped: time is for files

void loadMjcfFile(const std::filesystem::path& file) {
  try {
    const std::unique_ptr<Scene> scene = loadScene(file);
    if (scene->model.nv == 0 || scene->model.nv > kMostMjcfDofs) return;
    Run run(scene->model, scene->initial, &scene->source());
    run.steps({}, kMjcfSteps);
  } catch (const ModelError& error) {
    expectMessage(error.what());
    if (!std::string(error.what()).starts_with(file.string()))
      throw Finding(std::string("names no file: ") + error.what());
  } catch (const OptionError& error) {
    expectMessage(error.what());
  }
}

}  // namespace
}  // namespace softgauss::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace softgauss::fuzz;
  static const InputFolder folder;
  loadMjcfFile(folder.write("model.xml", textOf(data, size)));
  return 0;
}
