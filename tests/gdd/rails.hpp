// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A linear system.

#include "tests/support/scene.hpp"

namespace softgauss::test {

/// Five masses on rails of all directions, one hanging from another, with springs and dampers and
/// without gravity: M is constant, c = K q + D_v v. Joint 3 is passive where `passive`.
inline ModelBuilder rails(bool passive = false) {
  Random random(11);
  ModelBuilder b("rails");
  b.link(emptyLink("world"));
  std::string parent = "world";
  for (int i = 0; i < 5; ++i) {
    const std::string name = "mass" + std::to_string(i);
    b.link(boxLink(name, random.uniform(0.5, 3.0), Vector3(0.1, 0.1, 0.1)));
    JointSpec joint = jointSpec("rail" + std::to_string(i), JointType::prismatic, parent, name, {},
                                random.direction());
    joint.damping = random.uniform(0.1, 2.0);
    joint.stiffness = random.uniform(1.0, 30.0);
    if (passive && i == 3) joint.effort = 0.0;
    b.joint(joint);
    if (i != 1) parent = name;
  }
  b.options.effects.remove(Effect::gravity);
  return b;
}

}  // namespace softgauss::test
