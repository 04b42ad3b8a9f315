// SPDX-License-Identifier: Apache-2.0
#include "softgauss/engine/step/snapshot.hpp"

#include "softgauss/engine/dynamics/energy.hpp"
#include "softgauss/engine/step/sleep.hpp"
#include "softgauss/engine/step/substep_workspace.hpp"

namespace softgauss {
namespace {

constexpr double kCarriesAbove = 0.70710678118654752;  // cos 45°

}  // namespace

std::optional<Vector3> centerOfPressure(const Model& model,
                                        const std::vector<Snapshot::ContactForce>& contacts) {
  const double gravity = model.options.gravity.norm();
  if (gravity == 0.0) return std::nullopt;
  const Vector3 up = -model.options.gravity / gravity;
  Vector3 moment = Vector3::Zero();
  double load = 0.0;
  for (const Snapshot::ContactForce& c : contacts) {
    const bool worldIsA = model.geometries[c.geometryA].body == 0;
    if (!worldIsA && model.geometries[c.geometryB].body != 0) continue;
    const double upward = worldIsA ? c.n_W.dot(up) : -c.n_W.dot(up);
    if (upward < kCarriesAbove) continue;
    moment += c.normalForce() * c.p_WC;
    load += c.normalForce();
  }
  if (!(load > 0.0)) return std::nullopt;
  return moment / load;
}

void contactForces(const Data& data, std::vector<Snapshot::ContactForce>& contacts) {
  contacts.clear();
  appendContactForces(data, contacts);
  if (data.parts && data.parts->leavesAny()) {
    const std::vector<Snapshot::ContactForce>& others = data.parts->islands->contacts();
    contacts.insert(contacts.end(), others.begin(), others.end());
  }
  if (data.sleepers) data.sleepers->appendContacts(contacts);
}

void appendContactForces(const Data& data, std::vector<Snapshot::ContactForce>& contacts) {
  const PyramidalContact& pyramids = data.constraints.contact;
  const EllipticContact& cones = data.constraints.ellipticContact;
  const int pyramidCount = static_cast<int>(pyramids.contactsWithRows().size());
  const int coneCount = static_cast<int>(cones.contactsWithRows().size());
  // In the order of the contacts, of whichever kind.
  for (int i = 0, k = 0; i < pyramidCount || k < coneCount;) {
    const bool pyramid =
        k == coneCount || (i < pyramidCount && pyramids.contactsWithRows()[i].contact <
                                                   cones.contactsWithRows()[k].contact);
    const Contact& c = data.contacts.contacts[pyramid ? pyramids.contactsWithRows()[i].contact
                                                      : cones.contactsWithRows()[k].contact];
    const Vector3 force = pyramid ? pyramids.force(i) : cones.force(k);
    ++(pyramid ? i : k);
    if (data.parts && data.parts->leaves(c.bodyA != 0 ? c.bodyA : c.bodyB)) continue;
    contacts.push_back({c.geometryA, c.geometryB, c.p_WC, c.n_W, force});
  }
}

void addServoForces(const Data& data, VectorX& tau) {
  data.constraints.servo.addTransposed(data.constraints.servo.f, tau);
}

void appliedForces(const Data& data, VectorX& tau) {
  tau = data.forces.tau;
  addServoForces(data, tau);
  if (data.sleepers) data.sleepers->copyApplied(tau);
}

void takeSnapshot(const Model& model, const Kinematics& k,
                  const std::vector<Snapshot::ContactForce>& contacts, double time,
                  Snapshot& snapshot) {
  snapshot.time = time;
  snapshot.X_WB = k.X_WB;
  snapshot.velocity.assign(model.bodies.size(), Vector3::Zero());
  snapshot.angularVelocity.assign(model.bodies.size(), Vector3::Zero());
  for (int b = 1; b < model.bodyCount(); ++b) {
    snapshot.velocity[b] = pointVelocity(model, k, b, k.X_WB[b].p);
    snapshot.angularVelocity[b] = k.V[b].angular;
  }
  snapshot.contacts = contacts;
  snapshot.centerOfMass = centerOfMass(model, k);
  snapshot.centerOfPressure = centerOfPressure(model, snapshot.contacts);
}

void takeSnapshot(const Model& model, const Data& data, double time, Snapshot& snapshot) {
  std::vector<Snapshot::ContactForce> contacts;
  contactForces(data, contacts);
  takeSnapshot(model, data.kinematics, contacts, time, snapshot);
}

}  // namespace softgauss
