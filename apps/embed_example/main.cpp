// SPDX-License-Identifier: Apache-2.0

/// softgauss in a program of one's own: a robot stands and reaches, and the program prints where
/// its hand is, with what force its feet press on the ground, and the torque of its knee.
///
///   embed_example humanoid.urdf

#include <cstdio>
#include <exception>
#include <softgauss/softgauss.hpp>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: embed_example humanoid.urdf\n");
    return 2;
  }
  try {
    // A floating base starts with its feet on the ground. Forward is +x, up is +z.
    softgauss::Simulation sim = softgauss::Simulation::load(argv[1]);

    // Goals: the whole robot seeks the posture of the start, its hand a place in front of it [m].
    sim.goals.posture();
    const softgauss::Vector3 start = sim.pose("right_hand").p;
    const softgauss::Vector3 target = start + softgauss::Vector3(0.15, 0.0, 0.2);
    // The posture holds the arm back: the reach gets the larger weight [kg].
    sim.goals.reach("right_hand", target, softgauss::Vector3::Zero(), 1e4);

    while (sim.time() < 2.0) {
      sim.run(0.5);  // steps of sim.model().options.timestep; throws where one fails
      const double left = sim.contactForceOn("left_foot").z();
      const double right = sim.contactForceOn("right_foot").z();
      std::printf(
          "%.1f s: hand off by %4.0f mm, feet carry %3.0f + %3.0f N, right knee %+6.2f N m\n",
          sim.time(), 1e3 * (target - sim.pose("right_hand").p).norm(), left, right,
          sim.torque("right_knee"));
    }
    return 0;
  } catch (const std::exception& error) {  // names the file and line, or the time and joint
    std::fprintf(stderr, "embed_example: %s\n", error.what());
    return 1;
  }
}
