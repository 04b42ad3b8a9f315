// SPDX-License-Identifier: Apache-2.0

// Pairs of shapes that move, and a stack.

import { add, axisAngle, cross, dot, multiply, normalized, rotate, scale } from '../geometry.mjs';
import { Random } from '../random.mjs';
import { Scene, box, capsule, cylinder, sphere } from '../scene.mjs';

const shapes = {
  sphere: sphere(0.1),
  capsule: capsule(0.06, 0.12),
  box: box(0.1, 0.13, 0.08),
  cylinder: cylinder(0.1, 0.07),
};

// A point of a solid's surface and the normal there, in the solid's frame.
function surfacePoint(shape, random) {
  const { radius: r, halfLength: h, halfExtents } = shape;
  const around = random.uniform(0, 2 * Math.PI);
  const outward = [Math.cos(around), Math.sin(around), 0];
  switch (shape.kind) {
    case 'sphere': {
      const n = random.direction();
      return { p: scale(r, n), n };
    }
    case 'capsule': // its side
      return { p: add(scale(r, outward), [0, 0, random.uniform(-h, h)]), n: outward };
    case 'cylinder': {
      if (random.next() < 0.5) return { p: add(scale(r, outward), [0, 0, random.uniform(-h, h)]), n: outward };
      return { p: add(scale(random.uniform(0, r), outward), [0, 0, h]), n: [0, 0, 1] };
    }
    default: {
      const side = Math.floor(random.uniform(0, 3));
      const p = halfExtents.map((e, i) => (i === side ? e : random.uniform(-e, e)));
      return { p, n: [0, 1, 2].map((i) => (i === side ? 1 : 0)) };
    }
  }
}

// The rotation that takes unit vector a to b, then turns about b.
function turnTo(a, b, angle) {
  const half = normalized([1 + dot(a, b), ...cross(a, b)]);
  return multiply(axisAngle(b, angle), half);
}

// Bodies at random poses whose surfaces overlap by a given depth, about points with opposite normals.
function overlapping(a, b, depth, random) {
  const first = { p: random.vector(3, 0.5), q: random.quaternion() };
  const onFirst = surfacePoint(a, random);
  const onSecond = surfacePoint(b, random);
  const n = rotate(first.q, onFirst.n);
  const q = turnTo(onSecond.n, scale(-1, n), random.uniform(0, 2 * Math.PI));
  const touching = add(add(first.p, rotate(first.q, onFirst.p)), scale(-depth, n));
  const second = { p: add(touching, scale(-1, rotate(q, onSecond.p))), q };
  return { q: [...first.p, ...first.q, ...second.p, ...second.q], v: random.vector(12, 0.5) };
}

const pairs = [
  ['sphere', 'sphere'],
  ['sphere', 'capsule'],
  ['capsule', 'capsule'],
  ['sphere', 'box'],
  ['sphere', 'cylinder'],
  ['capsule', 'box'],
  ['box', 'box'],
];

// Two bodies in weightlessness that overlap by little, at random, and then fly apart.
function pair([a, b], index) {
  const random = new Random(40 + index);
  const states = Array.from({ length: 10 }, () =>
    overlapping(shapes[a], shapes[b], random.uniform(1e-4, 4e-3), random),
  );
  return {
    name: `pair_${a}_${b}`,
    about: `a ${a} and a ${b} that overlap, in weightlessness`,
    seed: 40 + index,
    options: { gravity: [0, 0, 0] },
    scene: new Scene().freeBody('first', 1, shapes[a]).freeBody('second', 2, shapes[b], { friction: [0.5, 0.005, 0.0001] }),
    start: states[0],
    states,
  };
}

const stack = new Scene().ground();
for (let i = 0; i < 3; ++i) stack.freeBody(`brick_${i}`, 1, box(0.1, 0.1, 0.1));

export const pairings = [
  ...pairs.map(pair),
  {
    name: 'box_stack',
    about: 'a stack of three boxes, the upper ones turned and shifted',
    scene: stack,
    start: {
      q: [0, 1, 2].flatMap((i) => [0.01 * i, -0.02 * i, 0.1 + 0.2 * i, Math.cos(0.1 * i), 0, 0, Math.sin(0.1 * i)]),
    },
    stateTimes: [0.05, 0.5, 1],
  },
];
