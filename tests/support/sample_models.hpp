// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Models made in code, so that tests need no file. Functions return builders: a test may change
/// options or add links before build().

#include <string>
#include <vector>

#include "softgauss/engine/model/model_builder.hpp"
#include "tests/support/random.hpp"

namespace softgauss::test {

// ---- Parts
// ---------------------------------------------------------------------------------------

/// A link with the inertia of a solid box or sphere about `com`.
LinkSpec boxLink(const std::string& name, double mass, const Vector3& halfExtents,
                 const Vector3& com = Vector3::Zero());
LinkSpec sphereLink(const std::string& name, double mass, double radius,
                    const Vector3& com = Vector3::Zero());
/// A link without inertia.
LinkSpec emptyLink(const std::string& name);
/// Any inertia a rigid body may have (the triangle inequality holds), in random axes.
LinkSpec randomLink(const std::string& name, Random& random);

JointSpec jointSpec(const std::string& name, JointType type, const std::string& parent,
                    const std::string& child, const Transform& X_PC = {},
                    const Vector3& axis = Vector3::UnitZ());
GeometrySpec geometrySpec(const std::string& link, const Shape& shape, double friction = 1.0,
                          const Transform& X_LG = {});
/// The ground: a plane through the world's origin whose normal is the z axis of R_WG.
GeometrySpec groundSpec(double friction, const Matrix3& R_WG = Matrix3::Identity());

// ---- Whole models
// --------------------------------------------------------------------------------

/// n links of 0.2 m and 1 kg on a fixed base, hinges about y and x in turn.
ModelBuilder chain(int n);

/// A mass on a light rod that swings about y: hinge at the origin, centre at −length z.
ModelBuilder pendulum(double length, double mass, double radius, double armature = 0.0,
                      double damping = 0.0);

/// A free rigid body called "body".
ModelBuilder freeBody(const LinkSpec& body);

/// A free sphere or box called "body" with its geometry, and the ground of R_WG.
ModelBuilder sphereOnPlane(double radius, double mass, double friction,
                           const Matrix3& R_WG = Matrix3::Identity());
ModelBuilder boxOnPlane(const Vector3& halfExtents, double mass, double friction,
                        const Matrix3& R_WG = Matrix3::Identity());

/// 6 + 21 degrees of freedom: capsules, spheres at hands, knees and head; feet are boxes. Joints of
/// two or three degrees of freedom go through links without mass. The soles are 0.9 m below the
/// pelvis. Includes the ground.
ModelBuilder humanoid();

struct RandomTreeOptions {
  int trees = 2;  ///< the first two are always one floating and one on a fixed base
  int links = 7;  ///< moving links with mass of each tree, about
  bool damping = true;
  bool armature = true;
  bool ranges = true;
  bool geometries = true;  ///< a small sphere on every massive link, and the ground
  // In randomScene() only, at random:
  bool dryFriction = false;
  bool springs = false;
  bool contactMoments = false;  ///< torsional and rolling friction of some shapes
  bool equalities =
      false;  ///< a connection, a weld, two couplings, almost met in the scene's state
};

/// Trees of every joint kind, with massless intermediates (universal joints), planar joints and
/// links on fixed joints, hanging from the link "world".
ModelBuilder randomForest(std::uint64_t seed, const RandomTreeOptions& options = {});

/// One floating tree with nothing that acts on it from outside but gravity.
ModelBuilder randomFloatingTree(std::uint64_t seed, bool armature = false);

}  // namespace softgauss::test
