// SPDX-License-Identifier: Apache-2.0
#include "apps/rivals/judge/published.hpp"

#include <cmath>

namespace rivals {

Measures measureElastic(const Scene& scene, const Trajectory& run) {
  const Energies start = energiesOf(scene, run.front());
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < run.size(); ++k) {
    const Energies e = energiesOf(scene, run[k]);
    sum += std::pow(e.kinetic + e.potential - start.potential, 2.0);
  }
  return {{"energy_error_J2", sum / static_cast<double>(run.size() - 1)}};
}

Measures measurePushed(const Scene& scene, const Trajectory& run) {
  const Vector3d force = scene.bodies[0].force;
  const double balls = scene.mass() - scene.bodies[0].mass;
  const double friction = scene.frictionOnGround() * scene.mass() * scene.gravity.norm();
  const Vector3d a =
      (force.norm() - friction) / (scene.bodies[0].mass + 2.0 / 7.0 * balls) * force.normalized();
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < run.size(); ++k) {
    const double t = static_cast<double>(k) * scene.sample;
    sum += (run[k][0].velocity - t * a).squaredNorm() +
           (run[k][1].velocity - 2.0 / 7.0 * t * a).squaredNorm();
  }
  return {{"velocity_error_m2_s2", sum / static_cast<double>(run.size() - 1)},
          {"box_speed", run.back()[0].velocity.norm()}};
}

}  // namespace rivals
