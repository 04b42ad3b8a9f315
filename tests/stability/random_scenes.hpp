// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Scenes drawn at random, to search for those that break the passivity bound. Nothing drives them.
/// The seed decides the scene, the same for every step; every second one has elliptic cones.

#include "tests/stability/scenes.hpp"

namespace softgauss::test {

struct RandomScene {
  explicit RandomScene(const ModelBuilder& builder) : model(builder.build()), state(model) {}
  Model model;
  State state;  ///< where it begins
};

/// A robot of 3 to 12 links, floating or fixed, on hinges and slides of which most have a range,
/// with no damping, some, or some armature too. Its joints begin at up to 10 rad/s or 1 m/s, up to
/// half a metre above the ground.
RandomScene randomRobot(int seed, double timestep);

/// Three to ten boxes of 0.01 to 10 kg, each tied to another one or to the world at random points,
/// some to the world once more, that fall from rest onto the ground.
RandomScene randomWeb(int seed, double timestep);

/// Two cubes of 0.2 m, tied side by side, that tumble onto the floor: the one of 1 kg, the other of
/// up to `ratio`, with `turn` [rad/s] about each axis at most. The equality constraint has an
/// impedance of 10⁻⁴ to 0.9.
RandomScene randomPair(int seed, double timestep, double ratio, double turn);
/// Makes its contacts as soft as the equality constraint, for every second two seeds.
void softenContacts(Model& pair, int seed);

/// A slider-crank without gravity: a flywheel of 0.1 to 20 kg and a slider of 0.02 to 2 kg on
/// joints of a heavy base, tied by a rod of 3 to 50 g that is a free body. It begins at its dead
/// centre, at 10 to 60 rad/s, and is left to itself.
RandomScene randomCrank(int seed, double timestep);

/// A cylinder, coin, capsule, box or sphere of 6 to 100 mm, thrown on the ground with up to
/// 100 rad/s. Half of them fall flat.
RandomScene randomThrown(int seed, double timestep);

// ---- What they are made with

/// A builder with this step; every second seed has elliptic cones.
ModelBuilder numbered(const std::string& kind, int seed, double timestep);

/// Any impedance of constant d, some with a reference that is given directly.
Impedance anyImpedance(Random& random, bool direct);

/// Puts the ground `clearance` [m] below everything.
void layGround(RandomScene& scene, double clearance);

/// Whether anything but the ground is in contact at the start.
bool overlaps(RandomScene& scene);

}  // namespace softgauss::test
