// SPDX-License-Identifier: Apache-2.0
/// A second way to ODE's row: the thrown box of the study, written from the manual's first example
/// without a line of the study. Prints where it ends.

#include <ode/ode.h>

#include <cmath>
#include <cstdio>

namespace {

dWorldID world;
dJointGroupID contacts;

void nearCallback(void*, dGeomID a, dGeomID b) {
  dContact contact[8];
  const int found = dCollide(a, b, 8, &contact[0].geom, sizeof(dContact));
  for (int i = 0; i < found; ++i) {
    contact[i].surface.mode = dContactApprox1;
    contact[i].surface.mu = 0.5;
    dJointAttach(dJointCreateContact(world, contacts, &contact[i]), dGeomGetBody(a),
                 dGeomGetBody(b));
  }
}

}  // namespace

int main() {
  dInitODE();
  world = dWorldCreate();
  const dSpaceID space = dSimpleSpaceCreate(nullptr);
  contacts = dJointGroupCreate(0);
  dWorldSetGravity(world, 0, 0, -9.81);
  dCreatePlane(space, 0, 0, 1, 0);
  const dBodyID box = dBodyCreate(world);
  dMass mass;
  dMassSetBoxTotal(&mass, 1.0, 0.2, 0.2, 0.1);
  dBodySetMass(box, &mass);
  dGeomSetBody(dCreateBox(space, 0.2, 0.2, 0.1), box);
  dBodySetPosition(box, 0, 0, 0.05);
  const double angle = 37.0 * M_PI / 180.0;
  dBodySetLinearVel(box, 2.0 * std::cos(angle), 2.0 * std::sin(angle), 0);
  for (int step = 0; step < 450; ++step) {
    dSpaceCollide(space, nullptr, nearCallback);
    dWorldStep(world, 0.002);
    dJointGroupEmpty(contacts);
  }
  const dReal* p = dBodyGetPosition(box);
  std::printf("[%.17g, %.17g, %.17g]\n", p[0], p[1], p[2]);
  dCloseODE();
}
