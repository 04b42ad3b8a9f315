// SPDX-License-Identifier: Apache-2.0
// Jolt from npm (JoltPhysics.js), in single precision. Friction of a pair is the root of the product, restitution the larger.
// Bodies without a shape have a sensor for one. Damping, sleep and the limit of 47 rad/s are off, gyroscopic forces on; slop 2 cm as it comes,
// slop=metres another; velocity_steps, position_steps=number: iterations of its solver.
import {bodyOf, cross, directionIn, forceAt, isDriven, times, turned} from './npm_vectors.mjs';

const kFixed = 0, kMoving = 1;  // layers
// Capsules lie along y.
const kUpright = [Math.SQRT1_2, Math.SQRT1_2, 0, 0];
const array = (v) => [v.GetX(), v.GetY(), v.GetZ()];
const orientation = (b) => ((q) => [q.GetW(), q.GetX(), q.GetY(), q.GetZ()])(b.GetRotation());

function settingsOfWorld(J, collide) {
  const pairs = new J.ObjectLayerPairFilterTable(2);
  pairs.EnableCollision(kFixed, kMoving);
  if (collide) pairs.EnableCollision(kMoving, kMoving);
  const phases = new J.BroadPhaseLayerInterfaceTable(2, 2);
  for (const layer of [kFixed, kMoving]) phases.MapObjectToBroadPhaseLayer(layer, new J.BroadPhaseLayer(layer));
  const settings = new J.JoltSettings();
  settings.mObjectLayerPairFilter = pairs;
  settings.mBroadPhaseLayerInterface = phases;
  settings.mObjectVsBroadPhaseLayerFilter = new J.ObjectVsBroadPhaseLayerFilterTable(phases, 2, pairs, 2);
  settings.mMaxWorkerThreads = 0;
  return settings;
}

// A box's convex radius is a tenth of its least half edge.
function shapeOf(J, shapes) {
  if (shapes.length === 0) return new J.SphereShape(0.01);
  const V = (a) => new J.Vec3(...a), Q = ([w, x, y, z]) => new J.Quat(x, y, z, w);
  const one = (s) => s.kind === 'box'  ? new J.BoxShapeSettings(V(s.size), 0.1 * Math.min(...s.size))
      : s.kind === 'sphere' ? new J.SphereShapeSettings(s.size[0]) : new J.CapsuleShapeSettings(s.size[1], s.size[0]);
  const turn = (s) => s.kind === 'capsule' ? times(s.orientation, kUpright) : s.orientation;
  if (shapes.length === 1 && shapes[0].kind !== 'capsule' && Math.hypot(...shapes[0].position) === 0 && shapes[0].orientation[0] === 1)
    return one(shapes[0]).Create().Get();
  const compound = new J.StaticCompoundShapeSettings();
  for (const s of shapes) compound.AddShape(V(s.position), Q(turn(s)), one(s), 0);
  const made = compound.Create().Get(), [x, y, z] = array(made.GetCenterOfMass());
  // A shape's centre is not where the body has its mass.
  return Math.hypot(x, y, z) < 1e-6 ? made : new J.OffsetCenterOfMassShapeSettings(V([-x, -y, -z]), compound).Create().Get();
}

export async function makeJolt(packages, scene, h, settings) {
  const J = await (await import(`${packages}/jolt-physics/dist/jolt-physics.wasm-compat.js`)).default();
  const V = (a) => new J.Vec3(...a), R = (a) => new J.RVec3(...a), Q = ([w, x, y, z]) => new J.Quat(x, y, z, w);
  const jolt = new J.JoltInterface(settingsOfWorld(J, scene.collide)), system = jolt.GetPhysicsSystem();
  const interface_ = system.GetBodyInterface();
  system.SetGravity(V(scene.gravity));
  const physics = system.GetPhysicsSettings();
  physics.mAllowSleeping = false;
  if (settings.slop) physics.mPenetrationSlop = Number(settings.slop);
  if (settings.velocity_steps) physics.mNumVelocitySteps = Number(settings.velocity_steps);
  if (settings.position_steps) physics.mNumPositionSteps = Number(settings.position_steps);
  system.SetPhysicsSettings(physics);
  const forces = [];  // a body, what the force's reaction acts on, an axis, and what tells the force along it
  const makeGround = () => {
    const c = new J.BodyCreationSettings(new J.BoxShape(V([50, 50, 1]), 0.05), R([0, 0, -1]), Q([1, 0, 0, 0]), J.EMotionType_Static, kFixed);
    c.mFriction = (scene.ground_friction ?? scene.friction) ** 2 / scene.friction;
    c.mRestitution = scene.restitution ?? 0;
    interface_.AddBody(interface_.CreateBody(c).GetID(), J.EActivation_DontActivate);
  };
  const makeBody = (b) => {
    const c = new J.BodyCreationSettings(shapeOf(J, b.shapes), R(b.position), Q(b.orientation), J.EMotionType_Dynamic, kMoving);
    Object.assign(c, {mFriction: scene.friction, mRestitution: scene.restitution ?? 0, mLinearDamping: 0, mAngularDamping: 0, mMaxAngularVelocity: 1e4,
      mMaxLinearVelocity: 1e4, mAllowSleeping: false, mApplyGyroscopicForce: true, mIsSensor: b.shapes.length === 0,
      mOverrideMassProperties: J.EOverrideMassProperties_MassAndInertiaProvided});
    const mass = c.mMassPropertiesOverride;
    mass.mMass = b.mass;
    mass.mInertia = J.Mat44.prototype.sScaleVec3(V(b.inertia));
    c.mMassPropertiesOverride = mass;
    const made = interface_.CreateBody(c);
    interface_.AddBody(made.GetID(), J.EActivation_Activate);
    made.SetLinearVelocity(V(b.velocity));
    made.SetAngularVelocity(V(b.angular_velocity));
    if (b.force) forces.push([made, undefined, b.force, {force: 1}]);
    return made;
  };
  if (scene.ground) makeGround();
  const bodies = scene.bodies.map(makeBody), force = V([0, 0, 0]);
  let steps = 0;
  for (const j of scene.joints) {
    const parent = j.parent < 0 ? J.JoltInterface.prototype.sGetFixedToWorldBody() : bodies[j.parent];
    let c;
    if (j.kind === 'ball' || j.kind === 'tie') {
      c = new J.PointConstraintSettings();
      c.mPoint1 = c.mPoint2 = R(j.anchor);
    } else {
      const across = cross(j.axis, Math.abs(j.axis[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]), long = Math.hypot(...across);
      const normal = V(across.map((x) => x / long));
      c = j.kind === 'hinge' ? new J.HingeConstraintSettings() : new J.SliderConstraintSettings();
      c.mPoint1 = c.mPoint2 = R(j.anchor);
      if (j.kind === 'hinge') c.mHingeAxis1 = c.mHingeAxis2 = V(j.axis);
      else c.mSliderAxis1 = c.mSliderAxis2 = V(j.axis);
      c.mNormalAxis1 = c.mNormalAxis2 = normal;
      if (j.range) [c.mLimitsMin, c.mLimitsMax] = j.range;
    }
    c.mSpace = J.EConstraintSpace_WorldSpace;
    system.AddConstraint(c.Create(parent, bodies[j.child]));
    if (isDriven(j)) forces.push([bodies[j.child], j.parent < 0 ? undefined : bodies[j.parent], directionIn(bodyOf(scene, j.parent), j.axis), j]);
  }
  const inverse = (b) => b.GetMotionProperties();
  return {
    mass: () => bodies.reduce((sum, b) => sum + 1 / inverse(b).GetInverseMass(), 0),
    kineticEnergy() {
      return bodies.reduce((sum, b) => {
        const q = b.GetRotation(), r = inverse(b).GetInertiaRotation(), I = array(inverse(b).GetInverseInertiaDiagonal()).map((x) => 1 / x);
        const axes = times([q.GetW(), q.GetX(), q.GetY(), q.GetZ()], [r.GetW(), r.GetX(), r.GetY(), r.GetZ()]);
        const w = turned([axes[0], -axes[1], -axes[2], -axes[3]], array(b.GetAngularVelocity())), v = array(b.GetLinearVelocity());
        return sum + 0.5 * (v.reduce((s, x) => s + x * x, 0) / inverse(b).GetInverseMass() + w.reduce((s, x, i) => s + I[i] * x * x, 0));
      }, 0);
    },
    step() {
      for (const [child, parent, axis, j] of forces) {
        const along = parent ? turned(orientation(parent), axis) : axis, f = forceAt(j, steps * h);
        force.Set(...along.map((x) => x * f));
        child.AddForce(force);
        force.Set(...along.map((x) => -x * f));
        if (parent) parent.AddForce(force, child.GetCenterOfMassPosition());
      }
      ++steps;
      jolt.Step(h, 1);
      return true;
    },
    state: () => bodies.map((b) => {
      const q = b.GetRotation();
      return {position: array(b.GetCenterOfMassPosition()), orientation: [q.GetW(), q.GetX(), q.GetY(), q.GetZ()],
        velocity: array(b.GetLinearVelocity()), angularVelocity: array(b.GetAngularVelocity())};
    })
  };
}
