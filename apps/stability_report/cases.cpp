// SPDX-License-Identifier: Apache-2.0
#include "apps/stability_report/cases.hpp"

#include <algorithm>
#include <cmath>

namespace softgauss::app {

Stage::Stage(Model m) : model(std::move(m)), contacts(model), kinematics(model), state(model) {}

double Stage::energy() {
  computeKinematics(model, state, kinematics);
  return computeEnergy(model, kinematics, state.q, state.v).total();
}
double Stage::kinetic() {
  computeKinematics(model, state, kinematics);
  return computeEnergy(model, kinematics, state.q, state.v).kinetic;
}
double Stage::overlap() {
  computeKinematics(model, state, kinematics);
  contacts.detect(model, kinematics, touching);
  double deepest = 0.0;
  for (const Contact& c : touching.contacts) deepest = std::max(deepest, -c.distance);
  return deepest;
}
Vector3 Stage::origin(const std::string& link) {
  computeKinematics(model, state, kinematics);
  const Frame& f = model.frames.at(static_cast<std::size_t>(model.findFrame(link)));
  return kinematics.X_WB[static_cast<std::size_t>(f.body)] * f.X_BF.p;
}
double Stage::tilt(const std::string& link) {
  computeKinematics(model, state, kinematics);
  const Frame& f = model.frames.at(static_cast<std::size_t>(model.findFrame(link)));
  const double z = (kinematics.X_WB[static_cast<std::size_t>(f.body)].R * f.X_BF.R)(2, 2);
  return std::acos(std::clamp(z, -1.0, 1.0));
}

namespace {

/// Of the energy, relative to `scale` joules: what the motion turns over.
Figure energyError(double scale, double bound) {
  return {"energy error",
          "%",
          100.0 / scale,
          bound,
          Figure::worst,
          [](Stage& s, double start) { return s.energy() - start; },
          [](Stage& s) { return s.energy(); }};
}

Figure overlapAtRest(double bound) {
  return {"overlap at rest",
          "mm",
          1e3,
          bound,
          Figure::last,
          [](Stage& s, double) { return s.overlap(); }};
}

/// The most that it is above its start.
Figure energyGained(double scale, double bound) {
  Figure figure = energyError(scale, bound);
  figure.name = "energy gained";
  figure.value = [](Stage& s, double start) { return std::max(0.0, s.energy() - start); };
  return figure;
}

Figure deepest(double bound) {
  Figure figure = overlapAtRest(bound);
  figure.name = "deepest overlap";
  figure.of = Figure::worst;
  return figure;
}

Figure tiltOf(const std::string& link, double bound) {
  return {"tilt",
          "°",
          180.0 / M_PI,
          bound,
          Figure::last,
          [link](Stage& s, double start) { return s.tilt(link) - start; },
          [link](Stage& s) { return s.tilt(link); }};
}

/// How far a heavy top leaves the tilts between which it nutates, [20°, 55.465°]. Begun at
/// cos θ = u₁ with its spin alone, p its moment, it turns where p² (u₁ − u) = 2 I m g l (1 − u²);
/// here p = 0.2 N m s, m g l = 0.981 N m, and I = 0.0112 kg m² about the point.
Figure nutation(double bound) {
  return {"tilt out of its range", "°", 180.0 / M_PI, bound, Figure::worst, [](Stage& s, double) {
            constexpr double kDegree = M_PI / 180.0;
            const double tilt = s.tilt("top");
            return std::max({0.0, 20.0 * kDegree - tilt, tilt - 55.465 * kDegree});
          }};
}

Figure sinks(const std::string& link, double bound) {
  return {"sinks in all",
          "mm",
          1e3,
          bound,
          Figure::last,
          [link](Stage& s, double start) { return start - s.origin(link).z(); },
          [link](Stage& s) { return s.origin(link).z(); }};
}

/// The worst of all connections.
Figure tieIsOff(double bound) {
  return {"tie is off", "mm", 1e3, bound, Figure::worst, [](Stage& s, double) {
            computeKinematics(s.model, s.state, s.kinematics);
            const auto at = [&](int body, const Vector3& p) {
              return s.kinematics.X_WB[static_cast<std::size_t>(body)] * p;
            };
            double off = 0.0;
            for (const Connection& c : s.model.connections)
              off = std::max(off, (at(c.bodyA, c.p_AP) - at(c.bodyB, c.p_BP)).norm());
            return off;
          }};
}

Figure creep(const std::string& link, double seconds, double bound) {
  return {"creep",
          "mm/s",
          1e3 / seconds,
          bound,
          Figure::last,
          [link](Stage& s, double start) { return s.origin(link).x() - start; },
          [link](Stage& s) { return s.origin(link).x(); }};
}

/// The first joint's motion from its start.
Figure jointCreep(double bound) {
  return {"creep",
          "rad",
          1.0,
          bound,
          Figure::last,
          [](Stage& s, double start) { return s.state.q[0] - start; },
          [](Stage& s) { return s.state.q[0]; }};
}

Figure speedAtRest(double bound) {
  return {"speed at rest", "mm/s or mrad/s", 1e3, bound, Figure::last, [](Stage& s, double) {
            return s.state.v.cwiseAbs().maxCoeff();
          }};
}

}  // namespace

std::vector<HardCase> hardCases() {
  constexpr double kWeight = 9.81;
  return {
      {"boxes_1_on_1", "1 kg on 1 kg", 5.0, {overlapAtRest(0.5), tiltOf("upper", 0.1)}},
      {"boxes_1000_on_1",
       "1000 kg on 1 kg",
       5.0,
       {overlapAtRest(2.0), sinks("upper", 2.0), tiltOf("upper", 0.1)}},
      {"light_feet",
       "100 kg on ankles and feet of 0.1 kg",
       5.0,
       {sinks("body", 2.0), speedAtRest(1e-3)}},
      {"tower_20",
       "tower of 20",
       10.0,
       {overlapAtRest(1.0), sinks("box19", 10.0), tiltOf("box19", 0.1)}},
      // Released level: what falls gains its weight times twice or once the distance to its centre.
      {"pendulum", "pendulum", 10.0, {energyError(0.5 * kWeight, 1.0)}},
      {"chain_10", "chain of 10", 10.0, {energyError(0.5 * kWeight, 1.0)}},
      {"chain_10_heavy", "chain of 10, tip × 1000", 10.0, {energyError(100.0 * kWeight, 1.0)}},
      {"chain_100", "chain of 100", 10.0, {energyError(2.0 * kWeight, 1.0)}},
      {"chain_100_heavy", "chain of 100, tip × 1000", 10.0, {energyError(40.0 * kWeight, 1.0)}},
      // The spin of 100 rad/s has 10 J.
      {"top", "heavy top, 100 rad/s", 10.0, {energyError(10.0, 1.0), nutation(1.0)}},
      {"tumbling", "free body, 50 rad/s", 10.0, {energyError(20.8, 1.0)}},
      // The top has 0.19 J and stands, the coin 0.02 J and rolls on.
      {"top_on_tip",
       "top on a rounded tip, 150 rad/s",
       4.0,
       {energyError(0.19, 1.0), tiltOf("top", 5.0)}},
      {"coin", "coin on its rim, 20 rad/s", 3.0, {energyGained(0.0204, 0.1), deepest(2.0)}},
      // No more than 0.01 mm beyond MuJoCo's.
      {"loop_1", "loop, 1 tie", 10.0, {tieIsOff(0.34)}},
      {"loop_2", "loop, 2 ties", 10.0, {tieIsOff(0.19)}},
      {"loop_5", "loop, 5 ties", 10.0, {tieIsOff(0.085)}},
      {"hung", "100 kg tied to 0.1 kg", 5.0, {sinks("load", 2.0), speedAtRest(1e-3)}},
      // The load falls by 0.5 m.
      {"rope",
       "100 kg swing on five tied bars of 0.1 kg",
       2.0,
       {tieIsOff(4.0), energyGained(0.5 * 100.0 * kWeight, 1.0)}},
      {"slope", "slope of 15°, μ 1", 10.0, {creep("box", 10.0, 2.0)}},
      {"slope_edge", "slope at 99 % of the cone", 60.0, {creep("box", 60.0, 5.0)}},
      {"slope_edge_hard", "the same, impedance_ratio 10", 60.0, {creep("box", 60.0, 5.0)}},
      {"slope_edge_elliptic", "the same, elliptic cones", 60.0, {creep("box", 60.0, 5.0)}},
      {"held", "dry friction beyond any torque", 60.0, {jointCreep(1e-6)}},
      {"springs", "springs of h/10", 5.0, {speedAtRest(1e-3)}},
      // A ball of 0.004 kg m² at 2 rad/s has 8 mJ.
      {"gimbal", "gimbal near alignment", 0.5, {energyError(8e-3, 1.0)}},
      {"tower_far", "tower 100 km from the origin", 5.0, {sinks("box2", 0.5), speedAtRest(1e-3)}},
      {"tower_small", "tower of 1 mm cubes", 5.0, {sinks("box2", 0.5), tiltOf("box2", 0.1)}},
      {"tower_large", "tower of 1 km cubes", 5.0, {sinks("box2", 0.5), tiltOf("box2", 0.1)}},
      {"sphere", "sphere at rest", 5.0, {overlapAtRest(0.5)}},
  };
}

}  // namespace softgauss::app
