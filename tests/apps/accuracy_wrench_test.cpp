// SPDX-License-Identifier: Apache-2.0
/// --accuracy where the scene pushes: a wrench begins and ends when it says, whatever the steps.

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "softgauss/engine/core/types.hpp"
#include "tests/apps/process.hpp"

namespace softgauss::test {
namespace {

// A box of 1 kg in free space, pushed by F for L: ½ F (t − s)² within, F L (t − s − ½ L) after.
TEST(Accuracy, IsKeptWhereAWrenchPushes) {
  for (const double length : {0.0005, 0.001, 0.02, 0.1})
    for (const double start : {0.075, 0.1258, 0.1978}) {
      const io::TempFolder folder;
      const std::string scene = folder.path() / "push.yaml", log = folder.path() / "log.csv";
      std::ofstream(scene) << fmt::format(
          "ground: none\ngravity: [0, 0, 0]\nobjects:\n"
          "  - {{name: box, box: {{size: [0.1, 0.1, 0.1]}}, mass: 1}}\n"
          "wrenches:\n  - {{link: box, force: [{}, 0, 0], start: {}, end: {}}}\n",
          1.0 / length, start, start + length);
      const Outcome outcome = simulate(
          {scene, "--passive", "--duration", "0.5", "--accuracy", "1e-4", "--log", log, "--quiet"});
      ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
      const Csv csv(readFile(log));
      double squares = 0.0;
      const int rows = static_cast<int>(csv.rows.size());
      for (int i = 0; i < rows; ++i) {
        const double t = csv.number(i, "time_s") - start;
        const double x = t <= 0.0 ? 0.0 : t <= length ? 0.5 * t * t / length : t - 0.5 * length;
        const double off = csv.number(i, "q:box.x") - x;
        squares += off * off;
      }
      EXPECT_LE(std::sqrt(squares / rows), 1e-4) << outcome.out;
    }
}

}  // namespace
}  // namespace softgauss::test
