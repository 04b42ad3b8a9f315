// SPDX-License-Identifier: Apache-2.0
#pragma once

/// A scene of the study beside other engines, in maximal coordinates: bodies where they start,
/// joints where they are, and what acts. It names no engine and holds no result; scenes.py writes
/// it, and whoever takes part reads it with his own eyes.
///
/// A body's frame is the principal frame of its inertia, at its centre of mass. Everything else is
/// in world axes: x, y level and z up, unless gravity is tilted. Units m, kg, s, N, rad.

#include <Eigen/Dense>
#include <Eigen/StdVector>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rivals {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

enum class ShapeKind { box, sphere, capsule };

struct Shape {
  ShapeKind kind;
  Vector3d size;  ///< half edges; radius; radius and half the length of the axis, which is z
  Isometry3d pose = Isometry3d::Identity();  ///< in the body
};

/// Pose and velocity of a body: what an engine is asked for, and all that the judge sees of it.
struct BodyState {
  Vector3d position;         ///< of the centre of mass
  Quaterniond orientation;   ///< of the principal axes
  Vector3d velocity;         ///< of the centre of mass
  Vector3d angularVelocity;  ///< in world axes

  Isometry3d pose() const;
};

struct Body {
  std::string name;
  double mass;
  Vector3d inertia;  ///< principal moments [kg m²]
  BodyState start;
  std::vector<Shape> shapes;
  Vector3d force =
      Vector3d::Zero();  ///< that acts at the centre of mass, constant, world [N]; of free bodies
};

/// A `tie` is a ball joint that closes no tree: what an engine has to hold by a constraint.
enum class JointKind { hinge, slider, ball, tie };

struct Joint {
  JointKind kind;
  int parent, child;  ///< bodies; a parent of −1 is the world, and it comes before its child
  Vector3d anchor;    ///< at the start, world
  Vector3d axis;      ///< at the start, world; of hinges and sliders
  std::optional<std::pair<double, double>> range;  ///< from the start [rad or m]
  double force = 0.0;                              ///< along the axis [N or N m], constant
  /// Of sliders: times [s], ascending, and the force that acts along the axis from each on [N]. The
  /// force on the child has its reaction on the parent.
  std::vector<std::pair<double, double>> program = {};

  bool isDriven() const { return force != 0.0 || !program.empty(); }
  /// The force along the axis at a time after the start [s].
  double forceAt(double time) const;
};

struct Scene {
  std::string name;
  std::string measure;  ///< what the judge looks at
  Vector3d gravity;
  double friction;          ///< Coulomb's coefficient of every pair, or of all but the ground's
  bool ground;              ///< the half space z < 0
  bool collide;             ///< bodies touch one another, not the ground alone
  double duration, sample;  ///< [s]
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  /// Of every pair: speed after an impact over speed before it.
  double restitution = 0.0;
  std::optional<double> groundFriction = {};  ///< of pairs with the ground, where it is another

  double frictionOnGround() const { return groundFriction.value_or(friction); }
  double mass() const;
  /// Speed at which the first body, a ball or a box that lies flat, meets the ground in a free fall
  /// from where it starts at rest [m/s].
  double fallSpeed() const;
  /// Pose of a body at the start; of −1, the world, the identity.
  Isometry3d startOf(int body) const;
  /// Speed of a joint along or about its axis at the start.
  double jointSpeed(const Joint& joint) const;
  /// The joint of a tree that carries a body, null where it floats; ties carry none.
  const Joint* carrier(int body) const;
};

/// Throws std::runtime_error, naming the file, where it cannot be read.
Scene readScene(const std::string& path);
Scene parseScene(const std::string& json);

}  // namespace rivals
