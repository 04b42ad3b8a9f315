// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The judge of the study: what came of a run, from poses and velocities alone. It knows the truth
/// of a scene by closed forms and conservation laws, and shares no code with any engine.

#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "apps/rivals/scene.hpp"

namespace rivals {

/// States of a scene's bodies, a sample after another; the first is the start.
using Trajectory = std::vector<std::vector<BodyState>>;
/// What was measured, by name with its unit, such as off_mm.
using Measures = std::map<std::string, double>;

inline constexpr double kMm = 1e3, kDegrees = 180.0 / std::numbers::pi;

/// Angle between two states of a body [rad].
inline double turnOf(const BodyState& a, const BodyState& b) {
  return a.orientation.angularDistance(b.orientation);
}

/// Reads what a run wrote. Throws std::runtime_error where the file does not hold whole samples.
Trajectory readTrajectory(const std::string& path, std::size_t bodies);

/// What differs between the scene and the first sample: metres, m/s, rad/s or rad, the largest.
double startError(const Scene& scene, const Trajectory& run);

struct Energies {
  double kinetic = 0.0, potential = 0.0;
  Vector3d linear = Vector3d::Zero(),
           angular = Vector3d::Zero();  ///< momenta, about the world's origin
};
Energies energiesOf(const Scene& scene, const std::vector<BodyState>& states);

/// By Scene::measure:
///   smooth   energy_percent: largest change of energy over the largest kinetic energy
///   free     that, momentum: of the angular momentum about the centre of mass, relative, and
///            parabola_mm: the centre of mass from its parabola
///   top      tilt_low_deg, tilt_high_deg, and tilt_error_deg: from the range of the closed form,
///   which
///            samples miss by what nutation does in half a sample, 0.07° in this scene
///   thrown   off_mm: along, and aside_mm: across the throw, from where Coulomb's law stops;
///            lifted_mm, turned_deg
///   slides   off_mm: down the slope, aside_mm
///   creep    creep_mm_s down the slope, aside_mm_s, over the second half
///   rolling  off_mm at the end, slip_percent: of the speed that the contact point has left
///   drop     deepest_mm, rebound_mm, rest_mm
///   tower    sinks_mm of the top, leans_deg, drift_mm, end_speed
///   grip     fell_mm, creep_um_s over the second half, lost_s: when it had fallen 50 mm, or −1
///   carried  slipped_mm, turned_deg of the last body in the first one, lost: 1 where it fell
///   cart     off_mm: along, aside_mm: from where its wheels slide and then roll
///   bounce   top1_mm, top2_mm, top3_mm: heights after the impacts; off_percent: the worst of the
///            three from e²ⁿ times the fall, in percent of the fall; deepest_mm, and turned_deg
///            until the fourth impact
///   nut      off_mm: sunk more than truth_mm, creep_mm_s over the second half, turned_deg, and
///            off_thread_mm: what it has sunk but not turned; aside_mm, leans_deg
///   feet     off_mm: the worse frame, along, aside_mm, turned_deg, slip_mm: the most that a frame
///            has moved while it stood and the other was lifted
///   peg      left_mm: above the ground at the end, leans_deg, overlap_mm: the deepest in a wall
///   rope     gap_mm: the widest of a joint, energy_percent
///   pile     deepest_mm ever, rest_mm: in the last second, end_kinetic, lowest_m
Measures measure(const Scene& scene, const Trajectory& run);

/// Distance of two runs, root mean square over samples and bodies: of the centres of mass, and of
/// the turn times the radius of gyration [m]. NaN where one is shorter.
double distanceOf(const Scene& scene, const Trajectory& run, const Trajectory& reference);

/// The range of angles between a heavy symmetrical top's axis and the vertical, by energy and
/// momentum [rad].
std::pair<double, double> tiltOfTop(const Scene& scene);

}  // namespace rivals
