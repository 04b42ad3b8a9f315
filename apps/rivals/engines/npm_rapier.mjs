// SPDX-License-Identifier: Apache-2.0
// Rapier from npm, in single precision. Friction and restitution of a pair are means. iterations=number: of its solver. Joints are impulse joints.
import {bodyOf, directionIn, forceAt, isDriven, pointIn, times, turned} from './npm_vectors.mjs';

const V = ([x, y, z]) => ({x, y, z}), Q = ([w, x, y, z]) => ({x, y, z, w});
const array = ({x, y, z}) => [x, y, z], orientation = (r) => (({x, y, z, w}) => [w, x, y, z])(r.rotation());
const kGround = 1, kBody = 2;
// Capsules lie along y.
const kUpright = [Math.SQRT1_2, Math.SQRT1_2, 0, 0];

function collider(R, s, scene) {
  const make = {
    box: () => R.ColliderDesc.cuboid(...s.size),
    sphere: () => R.ColliderDesc.ball(s.size[0]),
    capsule: () => R.ColliderDesc.capsule(s.size[1], s.size[0])
  };
  const q = s.kind === 'capsule' ? times(s.orientation, kUpright) : s.orientation;
  return make[s.kind]().setTranslation(...s.position).setRotation(Q(q)).setDensity(0).setFriction(scene.friction)
      .setRestitution(scene.restitution ?? 0).setCollisionGroups((kBody << 16) | (scene.collide ? kGround | kBody : kGround));
}

function jointData(R, scene, j) {
  const p = bodyOf(scene, j.parent), c = bodyOf(scene, j.child), at = [V(pointIn(p, j.anchor)), V(pointIn(c, j.anchor))];
  if (j.kind === 'hinge') return R.JointData.revoluteWithAxes(...at, V(directionIn(p, j.axis)), V(directionIn(c, j.axis)));
  if (j.kind === 'slider') return R.JointData.prismatic(...at, V(directionIn(c, j.axis)));
  return R.JointData.spherical(...at);
}

export async function makeRapier(packages, scene, h, settings) {
  const R = (await import(`${packages}/@dimforge/rapier3d-compat/dist/rapier.mjs`)).default;
  await R.init();
  const world = new R.World(V(scene.gravity));
  world.timestep = h;
  if (settings.iterations) world.numSolverIterations = Number(settings.iterations);
  const fixed = world.createRigidBody(R.RigidBodyDesc.fixed()), forces = [];
  if (scene.ground)
    world.createCollider(R.ColliderDesc.cuboid(50, 50, 1).setTranslation(0, 0, -1).setFriction(2 * (scene.ground_friction ?? scene.friction) - scene.friction)
        .setRestitution(scene.restitution ?? 0).setCollisionGroups((kGround << 16) | kBody), fixed);
  const bodies = scene.bodies.map((b) => {
    const r = world.createRigidBody(R.RigidBodyDesc.dynamic().setTranslation(...b.position).setRotation(Q(b.orientation))
        .setCanSleep(false).setLinearDamping(0).setAngularDamping(0)
        .setAdditionalMassProperties(b.mass, V([0, 0, 0]), V(b.inertia), Q([1, 0, 0, 0])));
    for (const s of b.shapes) world.createCollider(collider(R, s, scene), r);
    r.setLinvel(V(b.velocity), true);
    r.setAngvel(V(b.angular_velocity), true);
    if (b.force) forces.push([r, undefined, b.force, {force: 1}]);
    return r;
  });
  let steps = 0;
  for (const j of scene.joints) {
    const joint = world.createImpulseJoint(jointData(R, scene, j), j.parent < 0 ? fixed : bodies[j.parent], bodies[j.child], true);
    if (j.range) joint.setLimits(...j.range);
    if (isDriven(j)) forces.push([bodies[j.child], j.parent < 0 ? undefined : bodies[j.parent], directionIn(bodyOf(scene, j.parent), j.axis), j]);
  }
  world.propagateModifiedBodyPositionsToColliders();
  for (const r of bodies) r.recomputeMassPropertiesFromColliders();
  return {
    mass: () => bodies.reduce((sum, r) => sum + r.mass(), 0),
    kineticEnergy() {
      return bodies.reduce((sum, r) => {
        const v = array(r.linvel()), I = array(r.principalInertia()), q = r.rotation(), f = r.principalInertiaLocalFrame();
        const axes = times([q.w, q.x, q.y, q.z], [f.w, f.x, f.y, f.z]);
        const w = turned([axes[0], -axes[1], -axes[2], -axes[3]], array(r.angvel()));
        return sum + 0.5 * (r.mass() * v.reduce((s, x) => s + x * x, 0) + w.reduce((s, x, i) => s + I[i] * x * x, 0));
      }, 0);
    },
    step() {
      for (const r of forces.length ? bodies : []) r.resetForces(true);
      for (const [child, parent, axis, j] of forces) {
        const along = parent ? turned(orientation(parent), axis) : axis, f = forceAt(j, steps * h);
        child.addForce(V(along.map((x) => x * f)), true);
        if (parent) parent.addForceAtPoint(V(along.map((x) => -x * f)), child.translation(), true);
      }
      ++steps;
      world.step();
      return true;
    },
    state: () => bodies.map((r) => {
      const q = r.rotation();
      return {position: array(r.translation()), orientation: [q.w, q.x, q.y, q.z], velocity: array(r.linvel()), angularVelocity: array(r.angvel())};
    })
  };
}
