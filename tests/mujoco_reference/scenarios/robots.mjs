// SPDX-License-Identifier: Apache-2.0

// The project's robots: a humanoid on the ground, a hand that grasps, an arm that pushes.

import { axisAngle } from '../geometry.mjs';
import { box, sphere } from '../scene.mjs';
import { robotScene } from '../urdf.mjs';

const humanoid = () => robotScene('humanoid').ground();
const kJoints = 21;
const zeros = (count) => Array.from({ length: count }, () => 0);

// Joints of a scene in the order of its degrees of freedom, the floating ones left out.
const scalarJoints = (scene) => scene.joints.filter((j) => j.type === 'revolute').map((j) => j.name);
const values = (scene, named) => scalarJoints(scene).map((name) => named[name] ?? 0);

// Feet apart, the right leg carried forward.
const astride = { right_hip_roll: 0.3, left_hip_roll: 0.3 };
const stepping = {
  right_hip_pitch: 3,
  right_knee: 4,
  right_hip_roll: 1,
  left_hip_roll: 1,
  right_shoulder_pitch: -2,
  left_shoulder_pitch: 2,
};

// Hand: every flexion closes.
const palmUp = (withoutShapes) =>
  robotScene('hand', {
    root: 'fixed',
    pose: { quaternion: axisAngle([1, 0, 0], Math.PI) },
    withoutShapes,
  }).freeBody('ball', 0.1, sphere(0.035));
const hand = palmUp(['forearm']);
const closing = Object.fromEntries(
  scalarJoints(hand)
    .filter((name) => /flexion/.test(name) && !/wrist|metacarpal/.test(name))
    .map((name) => [name, /distal/.test(name) ? 0.05 : 0.15]),
);

// Two things to push, on ground that is smooth: a box and a ball.
const smooth = { friction: [0.2, 0.005, 0.0001] };
const pushing = (name, about, scene, shape, position) => ({
  name,
  about,
  scene: scene.ground(smooth).freeBody('parcel', 2, shape, smooth),
  start: {
    q: [...values(scene, reach), ...position, 1, 0, 0, 0],
    force: [...values(scene, { wrist_pitch: -2 }), ...zeros(6)],
    hold: true,
  },
  stateTimes: [0.05, 0.15, 0.5, 1],
});

// Arm: bent down, its fingers before what stands on the ground.
const arm = () => robotScene('arm', { withoutShapes: ['base'] });
const reach = { shoulder_pitch: 0.7, elbow_pitch: 0.6, wrist_pitch: -1.3 };

export const robots = [
  {
    name: 'humanoid_standing',
    about: 'the humanoid on its feet, held by the forces that balance its weight',
    scene: humanoid(),
    start: { q: [0, 0, 0.9197, 1, 0, 0, 0, ...zeros(kJoints)], hold: true },
    stateTimes: [0.1, 0.5],
    every: 0.1,
  },
  {
    name: 'humanoid_falling',
    about: 'the humanoid dropped from 10 cm, leaning, a step begun',
    scene: humanoid(),
    start: {
      q: [0, 0, 1.02, ...axisAngle([1, 2, 0], 0.2), ...values(humanoid(), astride)],
      v: [0.5, 0, 0, 0, 0.5, 0.2, ...values(humanoid(), stepping)],
    },
    stateTimes: [0.2, 1],
    every: 0.1,
  },
  {
    name: 'humanoid_lying',
    about: 'the humanoid two seconds after it was dropped on its back',
    scene: humanoid(),
    start: { q: [0, 0, 0.3, ...axisAngle([0, 1, 0], -Math.PI / 2), ...zeros(kJoints)] },
    settle: 2,
    stateTimes: [0, 1],
    every: 0.1,
  },
  {
    name: 'hand_grasp',
    about: 'the hand, palm up, closes on a ball',
    scene: hand,
    start: {
      q: [...zeros(24), 0.16, -0.01, 0.056, 1, 0, 0, 0],
      force: [...values(hand, closing), ...zeros(6)],
      hold: true,
    },
    stateTimes: [0.2, 1],
    every: 0.1,
  },
  {
    name: 'hand_fingers',
    about: 'thumb and fingers close on a ball in weightlessness, without the palm',
    options: { gravity: [0, 0, 0] },
    scene: palmUp(['forearm', 'palm', 'little_metacarpal', 'thumb_metacarpal']),
    start: {
      q: [...zeros(24), 0.15, -0.005, 0.06, 1, 0, 0, 0],
      force: [...values(hand, closing).map((f) => 0.4 * f), ...zeros(6)],
    },
    stateTimes: [0.3, 1],
    every: 0.1,
  },
  pushing(
    'arm_push',
    'the arm pushes a box along the ground with its fingers',
    arm(),
    box(0.08, 0.1, 0.065),
    [0.466, 0, 0.0649],
  ),
  pushing('arm_push_ball', 'the arm pushes a ball with its fingers', arm(), sphere(0.09), [0.475, 0, 0.0899]),
];
