// SPDX-License-Identifier: Apache-2.0

// Loops: points that coincide (connect), poses that coincide (weld), and more of them than needed.

import { axisAngle } from '../geometry.mjs';
import { Scene, box, capsule } from '../scene.mjs';

// Three bars between two pins of the world, 0.4 m apart; the fourth pin is an equality.
function fourBar(closings, options = {}) {
  const scene = new Scene();
  const bar = (name, parent, position) =>
    scene
      .solid(name, 1, capsule(0.02, 0.12), [0, 0, -0.15])
      .joint(`${name}_hinge`, 'revolute', parent, name, { axis: [0, 1, 0], position, damping: 0.02, armature: 0.005 });
  bar('left', 'world', [0, 0, 0]);
  scene
    .link('middle', 1.2, [0.002, 0.02, 0.02, 0, 0, 0], [0.2, 0, 0])
    .joint('middle_hinge', 'revolute', 'left', 'middle', { axis: [0, 1, 0], position: [0, 0, -0.3], damping: 0.02, armature: 0.005 });
  bar('right', 'world', [0.4, 0, 0]);
  for (const y of closings)
    scene.equality('connect', {
      linkA: 'middle',
      positionA: [0.4, y, 0],
      linkB: 'right',
      positionB: [0, y, -0.3],
      ...options,
    });
  return scene;
}

const swinging = { q: [0.5, -0.5, 0.5], v: [1, -1, 1] };

// A free brick that hangs from the world by an equality.
function hanging(kind, more = {}) {
  return new Scene().freeBody('brick', 2, box(0.1, 0.2, 0.3)).equality(kind, {
    linkA: 'brick',
    positionA: [0.02, 0.05, 0.3],
    quaternionA: kind === 'weld' ? axisAngle([1, 2, 3], 0.4) : undefined,
    linkB: 'world',
    positionB: [0, 0, 1.3],
    ...more,
  });
}

const kHangingStates = [
  { q: [0.01, 0.002, 1, 1, 0, 0, 0], v: [0.1, 0.2, 0.3, 0.4, 0.5, 0.6] },
  { q: [-0.02, -0.05, 1.003, 0.9, 0.1, -0.3, 0.2], v: [0.5, -1, 0.3, 2, -1, 3], force: [1, 2, 3, 0.1, 0.2, 0.3] },
];

export const loops = [
  {
    name: 'connect_hanging',
    about: 'a brick that hangs from a point of the world',
    scene: hanging('connect'),
    start: { q: [-0.02, -0.05, 1, 1, 0, 0, 0], v: [0.5, 0, 0, 0, 1, 0] },
    stateTimes: [0, 0.2, 0.5, 1],
    states: kHangingStates,
  },
  {
    name: 'weld_hanging',
    about: 'a brick that is welded to a pose of the world',
    scene: hanging('weld'),
    start: { q: [-0.02, -0.05, 1, 1, 0, 0, 0], v: [0.5, 0, 0, 0, 1, 0] },
    stateTimes: [0, 0.2, 0.5, 1],
    states: kHangingStates,
  },
  {
    name: 'weld_soft',
    about: 'a weld with solref and solimp of its own',
    scene: hanging('weld', { solref: [0.1, 0.5], solimp: [0.5, 0.9, 0.05, 0.5, 2] }),
    start: { q: [-0.02, -0.05, 1, 1, 0, 0, 0], v: [0.5, 0, 0, 0, 1, 0] },
    stateTimes: [0, 0.2, 0.5],
    states: kHangingStates,
  },
  {
    name: 'four_bar_connect',
    about: 'four bars in a plane, closed by three rows of which one is redundant',
    scene: fourBar([0]),
    start: swinging,
    stateTimes: [0, 0.2, 0.5, 1],
    states: [{ q: [0.4, -0.45, 0.5], v: [1, -2, 3], force: [1, 2, -3] }],
  },
  {
    name: 'four_bar_redundant',
    about: 'the same, closed twice: six rows for one degree of freedom',
    scene: fourBar([-0.05, 0.05]),
    start: swinging,
    stateTimes: [0, 0.2, 0.5, 1],
    states: [{ q: [0.4, -0.45, 0.5], v: [1, -2, 3], force: [1, 2, -3] }],
  },
  {
    name: 'four_bar_weld',
    about: 'a closed chain whose last hinge is rigid and redundant: six rows for three hinges',
    scene: (() => {
      const scene = fourBar([]);
      return scene.equality('weld', {
        linkA: 'middle',
        positionA: [0.4, 0, 0],
        linkB: 'right',
        positionB: [0, 0, -0.3],
      });
    })(),
    start: { q: [0.1, -0.1, 0.05], v: [0.2, -0.2, 0.1] },
    stateTimes: [0, 0.2, 0.5, 1],
    states: [{ q: [0.4, -0.45, 0.5], v: [1, -2, 3], force: [1, 2, -3] }],
  },
];
