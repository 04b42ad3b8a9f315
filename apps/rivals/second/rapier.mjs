// SPDX-License-Identifier: Apache-2.0
// A second way to Rapier's row: the thrown box of the study, written from its guide's first example
// without a line of the study. PACKAGES is a node_modules. Prints where the box ends.
const RAPIER = (await import(`${process.argv[2]}/@dimforge/rapier3d-compat/dist/rapier.mjs`)).default;
await RAPIER.init();
const world = new RAPIER.World({x: 0, y: 0, z: -9.81});
world.timestep = 0.002;
world.createCollider(RAPIER.ColliderDesc.cuboid(10, 10, 0.1).setTranslation(0, 0, -0.1).setFriction(0.5));
const angle = 37 * Math.PI / 180;
const box = world.createRigidBody(RAPIER.RigidBodyDesc.dynamic().setTranslation(0, 0, 0.05).setCanSleep(false)
    .setLinvel(2 * Math.cos(angle), 2 * Math.sin(angle), 0));
world.createCollider(RAPIER.ColliderDesc.cuboid(0.1, 0.1, 0.05).setMass(1).setFriction(0.5).setRestitution(0), box);
for (let step = 0; step < 450; ++step) world.step();
const {x, y, z} = box.translation();
console.log(JSON.stringify([x, y, z]));
process.exit(0);
