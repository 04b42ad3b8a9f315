// SPDX-License-Identifier: Apache-2.0
/// Where scenes are after some steps, against files.
///
/// In `--compatibility mujoco` the step is MuJoCo's, which does not change: four scenes come to the
/// same bits. One scene in the default mode is frozen: who moves it says so. With
/// SOFTGAUSS_UPDATE_GOLDEN=1 the files are rewritten, and the commit gives the reason.

#include <fstream>
#include <functional>

#include "tests/support/matchers.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

// Other compilers and libraries round differently; contacts multiply that over these few steps.
constexpr double kTolerance = 1e-9;

enum class Mode { compatible, standard };

struct GoldenScene {
  const char* name;
  Mode mode;
  int steps;
  std::function<Scene()> make;
};
void PrintTo(const GoldenScene& scene, std::ostream* out) { *out << scene.name; }

const GoldenScene kScenes[] = {
    {"chain", Mode::compatible, 400,
     [] {
       Scene s(chain(6).build());
       s.state.q = Random(1).vector(6, 1.0);
       return s;
     }},
    {"sliding_box", Mode::compatible, 400,
     [] {
       Scene s(boxOnPlane({0.1, 0.15, 0.05}, 2.0, 0.4).build(), std::make_shared<SampleContacts>());
       s.state.q[2] = 0.08;
       s.state.v << 1.0, 0.5, 0.0, 0.5, 1.0, 2.0;
       return s;
     }},
    {"falling_humanoid", Mode::standard, 250,
     [] {
       Scene s(humanoid().build(), std::make_shared<SampleContacts>());
       s.state.v = Random(2).vector(27, 0.5);
       return s;
     }},
    {"driven_forest", Mode::compatible, 60,
     [] {
       Random random(4);
       Scene s(randomForest(4).build());
       s.state = randomState(s.model, random, 0.5);
       s.input.tau = random.vector(s.model.nv, 3.0);
       return s;
     }},
    {"contacts_between_branches", Mode::compatible, 20,
     [] {
       Scene s = randomScene(9, 6);
       s.state.v *= 0.1;
       return s;
     }},
};

std::string pathOf(const GoldenScene& scene) {
  return std::string(SOFTGAUSS_SOURCE_DIR) + "/tests/golden/" + scene.name + ".txt";
}

void write(const GoldenScene& scene, const Scene& s) {
  std::ofstream file(pathOf(scene));
  file << "# " << scene.name << " after " << scene.steps << " steps: q, then v\n";
  file.precision(17);
  for (const VectorX* x : {&s.state.q, &s.state.v})
    for (const double value : *x) file << value << "\n";
}

/// The values of a file; 17 digits are all bits.
VectorX read(const GoldenScene& scene) {
  std::ifstream file(pathOf(scene));
  std::vector<double> values;
  for (std::string line; std::getline(file, line);)
    if (line.rfind("#", 0) != 0) values.push_back(std::strtod(line.c_str(), nullptr));
  return Eigen::Map<VectorX>(values.data(), static_cast<Eigen::Index>(values.size()));
}

class Golden : public testing::TestWithParam<GoldenScene> {};

TEST_P(Golden, SceneIsWhereItWas) {
  const GoldenScene& scene = GetParam();
  Scene s = scene.make();
  if (scene.mode == Mode::compatible) s.model.options.useMujocoModel();
  s.data = std::make_unique<Data>(s.model);
  int rows = 0;
  for (int i = 0; i < scene.steps; ++i) {
    ASSERT_EQ(s.step(), SolveStatus::converged) << "step " << i;
    rows += s.data->stats.rows;
  }
  if (s.contacts) {
    EXPECT_GT(rows, 0);
  }
  if (std::getenv("SOFTGAUSS_UPDATE_GOLDEN")) write(scene, s);

  const VectorX recorded = read(scene);
  ASSERT_GT(recorded.size(), 0) << "SOFTGAUSS_UPDATE_GOLDEN=1 writes " << pathOf(scene);
  VectorX state(s.model.nq + s.model.nv);
  state << s.state.q, s.state.v;
  EXPECT_APPROX(state, recorded, kTolerance);
#ifndef __clang__
  if (scene.mode == Mode::compatible) {
    EXPECT_EQ(state, recorded) << "other bits";
  }
#endif
}

INSTANTIATE_TEST_SUITE_P(Every, Golden, testing::ValuesIn(kScenes),
                         [](const auto& scene) { return std::string(scene.param.name); });

}  // namespace
}  // namespace softgauss::test
