// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/forces/gravity_compensation.hpp"

#include "tests/support/matchers.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scene.hpp"

namespace softgauss::test {
namespace {

/// Three hinges in a row, the last body with a link fixed to it, and a free body, at random.
Scene chain(double share, double ofPart) {
  Random random(3);
  ModelBuilder b("chain");
  b.options.gravity = {1.0, -2.0, -9.0};
  b.link(emptyLink("world"));
  std::string parent = "world";
  for (const char* name : {"a", "b", "c"}) {
    LinkSpec link = randomLink(name, random);
    link.gravityCompensation = share;
    b.link(link);
    b.joint(jointSpec(name, JointType::continuous, parent, name,
                      Transform{Matrix3::Identity(), random.vector3(0.3)}, random.direction()));
    parent = name;
  }
  LinkSpec part = randomLink("part", random);
  part.gravityCompensation = ofPart;
  b.link(part).joint(jointSpec("fixed", JointType::fixed, "c", "part",
                               Transform{Matrix3::Identity(), random.vector3(0.3)}));
  Scene s(b.build());
  s.state.q = random.vector(s.model.nq, 1.0);
  s.state.v = random.vector(s.model.nv, 1.0);
  return s;
}

VectorX forces(Scene& s) {
  s.stages();
  return s.data->forces.c;
}

}  // namespace

// What bears all weights is no gravity at all.
TEST(GravityCompensation, OfAllIsNoGravity) {
  Scene borne = chain(1.0, 1.0), weightless = chain(0.0, 0.0);
  weightless.model.options.gravity.setZero();
  Scene without(weightless.model);
  without.state = borne.state;
  EXPECT_SMALL((forces(borne) - forces(without)).norm(), 1e-12);
}

// c is linear in the share.
TEST(GravityCompensation, OfAPartActsAtItsOwnCentre) {
  Scene none = chain(0.0, 0.0), links = chain(0.6, 0.0), part = chain(0.0, 0.8),
        both = chain(0.6, 0.8);
  const VectorX c = forces(none);
  EXPECT_SMALL((forces(links) + forces(part) - c - forces(both)).norm(), 1e-12);
  EXPECT_GT((forces(part) - c).norm(), 1.0);
}

}  // namespace softgauss::test
