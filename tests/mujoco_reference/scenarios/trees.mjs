// SPDX-License-Identifier: Apache-2.0

// Trees without constraints: mass matrix, bias, smooth acceleration, integrators.

import { axes, dot, scale, add } from '../geometry.mjs';
import { Random } from '../random.mjs';
import { Scene, box, capsule, cylinder, sphere } from '../scene.mjs';

// A link whose principal axes are not its own.
function randomLink(scene, name, random) {
  const mass = random.uniform(0.3, 3);
  const spread = [0, 0, 0].map(() => mass * random.uniform(0.001, 0.02));
  const frame = axes(random.quaternion());
  // Σ over axes of spread (1 − e eᵀ)
  const trace = spread[0] + spread[1] + spread[2];
  const entry = (i, j) => {
    const products = frame.map((e, k) => spread[k] * e[i] * e[j]);
    return (i === j ? trace : 0) - products[0] - products[1] - products[2];
  };
  const inertia = [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)];
  scene.link(name, mass, inertia, random.vector(3, 0.1));
}

// Adds hinges, slides, planar joints, fixed joints and a floating base, with branches. Returns the
// names of the links.
function addRandomTree(scene, random, links, floating, prefix = '') {
  const names = [];
  for (let i = 0; i < links; ++i) {
    const name = `${prefix}link_${i}`;
    const joint = `${prefix}joint_${i}`;
    const parent = i === 0 ? 'world' : names[Math.floor(random.uniform(0, names.length))];
    const place = { position: random.vector(3, 0.3), quaternion: random.quaternion() };
    const moves = () => ({
      axis: random.direction(),
      damping: random.uniform(0, 0.3),
      armature: random.uniform(0, 0.2),
    });
    if (i === 0 && floating) {
      scene.joint(joint, 'floating', 'world', name, place);
    } else if (i % 5 === 4) {
      scene.joint(joint, 'fixed', parent, name, place);
    } else if (i % 7 === 3) {
      // Planar: two slides along the plane, a hinge about its normal.
      const [x, y, z] = axes(random.quaternion());
      const step = (k) => `${name}_step_${k}`;
      scene.link(step(1)).link(step(2));
      scene.joint(`${joint}_x`, 'prismatic', parent, step(1), { ...place, ...moves(), axis: x });
      scene.joint(`${joint}_y`, 'prismatic', step(1), step(2), { ...moves(), axis: y });
      scene.joint(`${joint}_z`, 'revolute', step(2), name, { ...moves(), axis: z });
    } else {
      const type = random.next() < 0.3 ? 'prismatic' : 'revolute';
      scene.joint(joint, type, parent, name, { ...place, ...moves() });
    }
    randomLink(scene, name, random);
    names.push(name);
  }
  return names;
}

function randomTree(name, about, seed, links, floating, options) {
  const scene = new Scene();
  addRandomTree(scene, new Random(seed), links, floating);
  const random = new Random(seed + 100);
  const joints = scene.joints.filter((joint) => !['fixed', 'floating'].includes(joint.type)).length;
  const state = () => ({
    q: [...(floating ? [...random.vector(3, 1), ...random.quaternion()] : []), ...random.vector(joints, 1)],
    v: random.vector(joints + (floating ? 6 : 0), 2),
    force: random.vector(joints + (floating ? 6 : 0), 3),
    wrenches: [0, links - 2].map((i) => ({
      link: `link_${i}`,
      force: random.vector(3, 5),
      moment: random.vector(3, 2),
    })),
  });
  const { q, v } = state();
  return { name, about, seed, options, scene, start: { q, v }, states: [state(), state(), state()] };
}

// Three floating trees in a heap, with spheres at their roots and at the ends of their branches.
function heap(seed) {
  const random = new Random(seed);
  const scene = new Scene().ground();
  const scalars = ['a_', 'b_', 'c_'].map((prefix) => {
    const names = addRandomTree(scene, random, 6, true, prefix);
    for (const link of [names[0], names.at(-1)])
      scene.geometry(`${link}_ball`, link, sphere(random.uniform(0.1, 0.2)), {
        position: random.vector(3, 0.05),
        friction: [random.uniform(0.2, 1.5), 0.005, 0.0001],
        condim: random.next() < 0.3 ? 1 : 3,
      });
    const isScalar = (joint) => joint.name.startsWith(prefix) && joint.axis;
    return scene.joints.filter(isScalar).length;
  });
  const state = () => ({
    q: scalars.flatMap((n) => [
      ...random.vector(2, 0.25),
      random.uniform(0, 0.5),
      ...random.quaternion(),
      ...random.vector(n, 0.7),
    ]),
    v: scalars.flatMap((n) => random.vector(n + 6, 1)),
    force: scalars.flatMap((n) => random.vector(n + 6, 3)),
  });
  const states = Array.from({ length: 6 }, state);
  return {
    name: 'random_trees_heap',
    about: 'three random trees on a heap: contacts couple their branches',
    seed,
    scene,
    start: { q: scalars.flatMap((n, i) => [0.8 * i, 0, 1.2, 1, 0, 0, 0, ...random.vector(n, 0.3)]) },
    states,
    stateTimes: [0.7],
    every: 0.1,
  };
}

// A chain of capsules that hangs from the world.
function chain(links, damping) {
  const scene = new Scene();
  let parent = 'world';
  for (let i = 0; i < links; ++i) {
    const name = `link_${i}`;
    scene.solid(name, 1, capsule(0.03, 0.12), [0, 0, -0.15]);
    scene.joint(`joint_${i}`, 'revolute', parent, name, {
      axis: i % 2 ? [1, 0, 0] : [0, 1, 0],
      position: i ? [0, 0, -0.3] : [0, 0, 0],
      damping,
      armature: 0.01,
    });
    parent = name;
  }
  return scene;
}

const kIntegrators = ['Euler', 'RK4', 'implicit', 'implicitfast'];

export const trees = [
  randomTree('random_tree_fixed', 'a fixed base with hinges, slides, planar and fixed joints', 11, 12, false),
  randomTree('random_tree_floating', 'a floating base with hinges, slides, planar and fixed joints', 12, 12, true),
  randomTree('random_tree_large', 'thirty links on a floating base, gravity askew', 13, 30, true, {
    gravity: [3, -2, -9],
  }),
  heap(14),
  {
    name: 'damped_chain',
    about: 'four hinges with damping and armature, by every integrator',
    scene: chain(4, 0.5),
    start: { q: [0.6, 0.4, -0.5, 0.3], v: [1, -2, 3, 1] },
    stateTimes: [0, 0.5, 1],
    integrators: kIntegrators,
  },
  {
    name: 'free_chain',
    about: 'four hinges without damping, by every integrator',
    scene: chain(4, 0),
    start: { q: [0.6, 0.4, -0.5, 0.3], v: [1, -2, 3, 1] },
    integrators: kIntegrators,
  },
  {
    name: 'tumbling_box',
    about: 'a free box that tumbles about its middle axis in flight, by every integrator',
    scene: new Scene().freeBody('brick', 2, box(0.1, 0.2, 0.3)),
    start: { q: [0, 0, 2, 1, 0, 0, 0], v: [1, 0.5, 2, 0.1, 6, 0.2] },
    stateTimes: [0, 0.5],
    integrators: kIntegrators,
  },
];
