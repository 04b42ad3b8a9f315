// SPDX-License-Identifier: Apache-2.0
/// SCENE.json STATES [REFERENCE]: a line of JSON with what was measured.

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/rivals/judge/measures.hpp"
#include "apps/rivals/judge/overlap.hpp"

int main(int argc, char** argv) {
  try {
    if (argc < 3) throw std::invalid_argument("usage: SCENE.json STATES [REFERENCE]");
    const rivals::Scene scene = rivals::readScene(argv[1]);
    const rivals::Trajectory run = rivals::readTrajectory(argv[2], scene.bodies.size());
    nlohmann::json out;
    out["samples"] = run.size();
    out["gate"] = {{"start_error", rivals::startError(scene, run)},
                   {"mass", scene.mass()},
                   {"kinetic_energy", rivals::energiesOf(scene, run.front()).kinetic},
                   {"overlap_at_start", rivals::deepestOverlap(scene, run.front())}};
    out["measures"] = rivals::measure(scene, run);
    if (argc > 3) {
      const double error =
          rivals::distanceOf(scene, run, rivals::readTrajectory(argv[3], scene.bodies.size()));
      if (std::isfinite(error)) out["measures"]["error_m"] = error;
    }
    std::cout << out.dump() << '\n';
    return 0;
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
