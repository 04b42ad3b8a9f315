// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "tests/stability/random_scenes.hpp"

namespace softgauss::test {
namespace {

struct Part {
  std::string name;
  Shape shape;
  double mass = 0.0;
  Vector3 centre = Vector3::Zero();  ///< of the shape and of mass, from its joint
};

/// A torso is a box about its joint, a limb a capsule below it.
Part randomPart(int i, Random& random) {
  Part part;
  part.name = "link" + std::to_string(i);
  if (i == 0) {
    part.mass = decades(random, 0.5, 20.0);
    part.shape = Shape::box(Vector3::Constant(0.125) + random.vector3(0.075));
  } else {
    part.mass = decades(random, 0.05, 5.0);
    const double half = decades(random, 0.04, 0.2);
    const double radius = half * random.uniform(0.15, 0.4);
    part.shape = Shape::capsule(radius, half - radius);
    part.centre.z() = -half;
  }
  return part;
}

/// Where a child is joined: on a face of the torso, at the far end of a limb.
Vector3 socketOf(const Part& part, Random& random) {
  if (part.shape.kind != ShapeKind::box) return 2.0 * part.centre;
  Vector3 p = random.vector3(1.0).cwiseProduct(part.shape.halfExtents);
  const int face = random.index(3);
  p[face] = std::copysign(part.shape.halfExtents[face], p[face]);
  return p;
}

void addPart(ModelBuilder& builder, const Part& part, double friction) {
  const Shape& s = part.shape;
  const Vector3 half = s.kind == ShapeKind::box
                           ? s.halfExtents
                           : Vector3(s.radius, s.radius, s.halfLength + s.radius);
  builder.link(boxLink(part.name, part.mass, half, part.centre));
  builder.geometry(geometrySpec(part.name, s, friction, {Matrix3::Identity(), part.centre}));
}

enum class Damped { no, some, someWithArmature };

JointSpec randomJoint(const std::string& parent, const Vector3& socket, const std::string& child,
                      Damped damped, Random& random) {
  const bool slide = random.chance(0.1), ranged = slide || random.chance(0.8);
  const JointType turns = ranged ? JointType::revolute : JointType::continuous;
  const Matrix3 R = random.rotation();
  JointSpec joint = jointSpec("to " + child, slide ? JointType::prismatic : turns, parent, child,
                              {R, socket}, random.direction());
  if (ranged) {
    const double reach = slide ? 0.1 : 1.5;
    joint.lower = -reach * random.uniform(0.2, 1.0);
    joint.upper = reach * random.uniform(0.2, 1.0);
  }
  if (damped != Damped::no && random.chance(0.5)) joint.damping = decades(random, 1e-3, 1.0);
  if (damped == Damped::someWithArmature && random.chance(0.5))
    joint.armature = decades(random, 1e-4, 0.1);
  return joint;
}

bool slides(const Body& body) { return body.joint == JointKind::prismatic; }

ModelBuilder randomLimbs(int seed, double timestep, Random& random) {
  ModelBuilder builder = numbered("robot", seed, timestep);
  const bool floats = random.chance(0.5);
  const auto damped = static_cast<Damped>(random.index(3));
  const double friction = random.uniform(0.3, 1.2);
  builder.base = floats ? BaseKind::floating : BaseKind::fixed;
  if (!floats) builder.link(emptyLink("world"));
  builder.geometry(groundSpec(friction));
  std::vector<Part> parts;
  const int count = 3 + random.index(10);
  for (int i = 0; i < count; ++i) {
    const Part part = randomPart(i, random);
    addPart(builder, part, friction);
    if (i > 0) {  // chains, which branch
      const Part& parent = parts[random.chance(0.5) ? i - 1 : random.index(i)];
      const Vector3 socket = socketOf(parent, random);
      builder.joint(randomJoint(parent.name, socket, part.name, damped, random));
    } else if (!floats) {
      builder.joint(randomJoint("world", Vector3::Zero(), part.name, damped, random));
    }
    parts.push_back(part);
  }
  return builder;
}

/// Joints near the middle of their ranges, nearer while anything overlaps.
void pose(RandomScene& scene, Random& random) {
  double reach = 1.0;
  do {
    for (const Body& body : scene.model.bodies)
      if (body.dofs == 1)
        scene.state.q[body.q] = random.uniform(-reach, reach) * (slides(body) ? 0.05 : 0.5);
    reach *= 0.9;
  } while (overlaps(scene));
}

}  // namespace

RandomScene randomRobot(int seed, double timestep) {
  Random random(seed);
  const double clearance = decades(random, 0.001, 0.5);
  RandomScene scene(randomLimbs(seed, timestep, random));
  pose(scene, random);
  for (const Body& body : scene.model.bodies) {
    const double fastest = body.dofs == 6 ? 3.0 : (slides(body) ? 1.0 : 10.0);
    scene.state.v.segment(body.v, body.dofs) = random.vector(body.dofs, fastest);
  }
  layGround(scene, clearance);
  return scene;
}

}  // namespace softgauss::test
