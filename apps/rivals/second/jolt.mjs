// SPDX-License-Identifier: Apache-2.0
// A second way to Jolt's row: the thrown box of the study, written from its first example without a
// line of the study. PACKAGES is a node_modules. Prints where the box ends.
const Jolt = await (await import(`${process.argv[2]}/jolt-physics/dist/jolt-physics.wasm-compat.js`)).default();
const settings = new Jolt.JoltSettings();
const layers = new Jolt.ObjectLayerPairFilterTable(2);
layers.EnableCollision(0, 1);
const phases = new Jolt.BroadPhaseLayerInterfaceTable(2, 2);
phases.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
phases.MapObjectToBroadPhaseLayer(1, new Jolt.BroadPhaseLayer(1));
settings.mObjectLayerPairFilter = layers;
settings.mBroadPhaseLayerInterface = phases;
settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(phases, 2, layers, 2);
settings.mMaxWorkerThreads = 0;
const jolt = new Jolt.JoltInterface(settings), bodies = jolt.GetPhysicsSystem().GetBodyInterface();
jolt.GetPhysicsSystem().SetGravity(new Jolt.Vec3(0, 0, -9.81));
const add = (half, at, moves) => {
  const made = new Jolt.BodyCreationSettings(new Jolt.BoxShape(new Jolt.Vec3(...half), 0.005), new Jolt.RVec3(...at),
      new Jolt.Quat(0, 0, 0, 1), moves ? Jolt.EMotionType_Dynamic : Jolt.EMotionType_Static, moves ? 1 : 0);
  Object.assign(made, {mFriction: 0.5, mLinearDamping: 0, mAngularDamping: 0, mAllowSleeping: false});
  const body = bodies.CreateBody(made);
  bodies.AddBody(body.GetID(), moves ? Jolt.EActivation_Activate : Jolt.EActivation_DontActivate);
  return body;
};
add([10, 10, 0.1], [0, 0, -0.1], false);
const box = add([0.1, 0.1, 0.05], [0, 0, 0.05], true), angle = 37 * Math.PI / 180;
box.SetLinearVelocity(new Jolt.Vec3(2 * Math.cos(angle), 2 * Math.sin(angle), 0));
for (let step = 0; step < 450; ++step) jolt.Step(0.002, 1);
const p = box.GetCenterOfMassPosition();
console.log(JSON.stringify([p.GetX(), p.GetY(), p.GetZ()]));
process.exit(0);
