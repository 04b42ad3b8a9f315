// SPDX-License-Identifier: Apache-2.0

// Rows of single joints: ranges, springs, dry friction, couplings.

import { Scene, box, capsule, sphere } from '../scene.mjs';

const kWings = { position: [0, 0, 0] };

// A hinge about y with a rod that hangs down.
function pendulum(joint, name = 'rod', scene = new Scene(), place = kWings) {
  return scene
    .solid(name, 1, capsule(0.03, 0.2), [0, 0, -0.25])
    .joint(`${name}_hinge`, 'revolute', 'world', name, { axis: [0, 1, 0], armature: 0.01, ...place, ...joint });
}

function slider(joint) {
  return new Scene()
    .solid('block', 2, box(0.1, 0.1, 0.1), [0, 0, 0])
    .joint('rail', 'prismatic', 'world', 'block', { axis: [1, 0, 0.3], armature: 0.1, ...joint });
}

// Three hinges with dry friction and ranges, whose last link strikes the ground.
function rubbingChain() {
  const scene = new Scene().geometry('ground', 'world', { kind: 'plane' }, { position: [0, 0, -0.82] });
  let parent = 'world';
  for (let i = 0; i < 3; ++i) {
    const name = `link_${i}`;
    scene.solid(name, 1 - 0.2 * i, capsule(0.03, 0.12), [0, 0, -0.15]);
    scene.joint(`joint_${i}`, 'revolute', parent, name, {
      axis: i === 1 ? [1, 0, 0] : [0, 1, 0],
      position: i ? [0, 0, -0.3] : [0, 0, 0],
      range: [-0.7, 0.7],
      dryFriction: 0.3 / (1 + i),
      damping: 0.02,
      armature: 0.005,
    });
    parent = name;
  }
  return scene.geometry('tip', parent, sphere(0.04), { position: [0, 0, -0.3] });
}

// Two pendulums, the second follows the first.
function pair(polynomial, solver = {}) {
  const scene = pendulum({ damping: 0.02 }, 'leader');
  pendulum({ damping: 0.02 }, 'follower', scene, { position: [0, 0.3, 0] });
  return scene.equality('joint', {
    follower: 'follower_hinge',
    leader: 'leader_hinge',
    polynomial,
    ...solver,
  });
}

const kPendulumStates = [
  { q: [1.0475], v: [0.3] },
  { q: [1.0471], v: [2] },
  { q: [-1.049], v: [-1], force: [3] },
  { q: [1.06], v: [0] },
  { q: [0.2], v: [1] },
];

export const joints = [
  {
    name: 'pendulum_limit',
    about: 'a pendulum that swings against both ends of its range',
    scene: pendulum({ damping: 0.05, range: [-1.047, 1.047] }),
    start: { q: [1], v: [4] },
    stateTimes: [0.05, 0.1, 0.5],
    states: kPendulumStates,
  },
  {
    name: 'pendulum_limit_soft',
    about: 'a range with a margin and with solref and solimp of its own',
    scene: pendulum({ range: [-1.047, 1.047], margin: 0.05, solref: [0.05, 0.6], solimp: [0.4, 0.97, 0.02, 0.3, 3] }),
    start: { q: [1], v: [4] },
    stateTimes: [0.05, 0.1, 0.5],
    states: kPendulumStates,
  },
  {
    name: 'pendulum_limit_stiff',
    about: 'a time constant below two steps, which both engines raise to two steps',
    scene: pendulum({ range: [-1.047, 1.047], solref: [0.001, 1] }),
    start: { q: [1], v: [4] },
    stateTimes: [0.05, 0.1, 0.5],
    states: kPendulumStates,
  },
  {
    name: 'pendulum_limit_direct',
    about: 'a range whose solref gives stiffness and damping directly (negative numbers)',
    scene: pendulum({ range: [-1.047, 1.047], solref: [-3000, -40] }),
    start: { q: [1], v: [4] },
    stateTimes: [0.05, 0.1, 0.5],
    states: kPendulumStates,
  },
  {
    name: 'slider_limit',
    about: 'a slider that falls onto the end of its range',
    scene: slider({ range: [-0.2, 0.2] }),
    start: { q: [0], v: [-1] },
    stateTimes: [0.2, 0.5, 1],
    states: [{ q: [0.2003], v: [0.5] }, { q: [0.21], v: [1] }],
  },
  {
    name: 'slider_spring',
    about: 'a slider on a spring with a rest length and damping',
    scene: slider({ stiffness: 80, springReference: 0.15, damping: 1 }),
    start: { q: [0], v: [-1] },
    stateTimes: [0, 0.2, 0.5],
  },
  {
    name: 'pendulum_spring',
    about: 'a pendulum on an undamped spring',
    scene: pendulum({ stiffness: 6, springReference: -0.4 }),
    start: { q: [0.8], v: [0] },
    stateTimes: [0, 0.3, 0.6],
  },
  {
    name: 'slider_dry_friction',
    about: 'a slider with dry friction that slides and comes to rest',
    scene: slider({ dryFriction: 8, damping: 0.5 }),
    start: { q: [0], v: [1] },
    stateTimes: [0, 0.2, 0.5, 1],
    states: [
      { q: [0.1], v: [0], force: [4] },
      { q: [0.1], v: [1e-3], force: [12] },
      { q: [0.1], v: [-2], force: [20] },
    ],
  },
  {
    name: 'pendulum_dry_friction',
    about: 'a pendulum with dry friction, with solref and solimp of its own',
    scene: pendulum({ dryFriction: 0.8, solref: [0.04, 1], solimp: [0.7, 0.9, 0.01, 0.5, 2] }),
    start: { q: [1.2], v: [0] },
    stateTimes: [0, 0.3, 0.6, 1],
    states: [{ q: [0.05], v: [0] }],
  },
  {
    name: 'chain_dry_friction',
    about: 'three hinges with dry friction and ranges, whose tip strikes the ground',
    scene: rubbingChain(),
    start: { q: [0.69, -0.6, 0.65], v: [0.5, 1, 2] },
    stateTimes: [0.05, 0.25, 0.5, 1],
    states: [{ q: [0.1, -0.71, 0.72], v: [0, 1e-4, 0], force: [0.1, 0.05, -0.2] }],
  },
  {
    name: 'mimic_pair',
    about: 'a joint that follows another linearly',
    scene: pair([0.1, -2, 0, 0, 0]),
    start: { q: [0.3, -0.5], v: [1, -2] },
    stateTimes: [0, 0.2, 0.5, 1],
    states: [{ q: [0.2, -0.25], v: [1, -1], force: [1, -2] }],
  },
  {
    name: 'coupled_pair',
    about: 'a joint that follows a polynomial of another, with solref and solimp of its own',
    scene: pair([0.1, -1.5, 0.3, -0.2, 0.1], { solref: [0.03, 0.8], solimp: [0.8, 0.99, 0.01, 0.5, 2] }),
    start: { q: [0.3, -0.5], v: [1, -2] },
    stateTimes: [0, 0.2, 0.5, 1],
    states: [{ q: [0.7, -0.25], v: [1, -1], force: [1, -2] }],
  },
];
