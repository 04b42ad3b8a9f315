// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a viewer draws of one instant: poses, velocities, contacts with their forces, balance.
///
/// The engine's whole side of any viewer, recorder or debug drawing. The shapes that the poses
/// carry are Model::geometries and Model::visuals. Everything is in world axes.

#include <optional>

#include "softgauss/engine/step/data.hpp"

namespace softgauss {

struct Snapshot {
  /// A contact as geometries and a force see it.
  struct ContactForce {
    int geometryA = 0;  ///< indices into Model::geometries
    int geometryB = 0;
    Vector3 p_WC = Vector3::Zero();   ///< where the force acts [m]
    Vector3 n_W = Vector3::UnitZ();   ///< unit normal from A to B
    Vector3 force = Vector3::Zero();  ///< on B; A feels the opposite [N]

    double normalForce() const { return force.dot(n_W); }  ///< ≥ 0 [N]
  };

  double time = 0.0;                     ///< [s]
  std::vector<Transform> X_WB;           ///< (bodies)
  std::vector<Vector3> velocity;         ///< (bodies) of the body's origin [m/s]
  std::vector<Vector3> angularVelocity;  ///< (bodies) [rad/s]
  std::vector<ContactForce> contacts;    ///< within their margins; those not pressed have no force
  Vector3 centerOfMass = Vector3::Zero();   ///< of all moving bodies [m]
  std::optional<Vector3> centerOfPressure;  ///< see below
};

/// Mean of the points at which the world carries bodies, weighted by normal force [m]. Nothing when
/// it carries none. The world carries where it pushes a body within 45° of upwards.
std::optional<Vector3> centerOfPressure(const Model& model,
                                        const std::vector<Snapshot::ContactForce>& contacts);

/// The contacts of the last solve, with their forces; those of islands that took parts of their own
/// (island_substeps.hpp) after the others, then those of who sleeps (sleep.hpp).
void contactForces(const Data& data, std::vector<Snapshot::ContactForce>& contacts);
/// Appends those of the solve of `data` itself.
void appendContactForces(const Data& data, std::vector<Snapshot::ContactForce>& contacts);

/// Of the last solve: what acts on each dof from controls, Input::tau and servos (nv) [N m or N].
void appliedForces(const Data& data, VectorX& tau);
/// tau += the forces of servos alone (nv).
void addServoForces(const Data& data, VectorX& tau);

/// Poses and velocities of `kinematics` at `time`, and these contacts.
void takeSnapshot(const Model& model, const Kinematics& kinematics,
                  const std::vector<Snapshot::ContactForce>& contacts, double time,
                  Snapshot& snapshot);

/// The instant whose stages `data` holds: after step(), that is the step's start at `time`.
void takeSnapshot(const Model& model, const Data& data, double time, Snapshot& snapshot);

}  // namespace softgauss
