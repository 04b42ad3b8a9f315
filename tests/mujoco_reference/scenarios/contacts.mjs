// SPDX-License-Identifier: Apache-2.0

// Single bodies on a plane: shapes, condim, friction, softness, cones, a slope.

import { axisAngle, multiply } from '../geometry.mjs';
import { Random } from '../random.mjs';
import { Scene, box, capsule, cylinder, sphere } from '../scene.mjs';

const kFriction = [0.8, 0.05, 0.01]; // large enough for spin and roll to be seen

const kShapes = {
  sphere: { shape: sphere(0.1), height: 0.1, turn: [1, 0, 0, 0] },
  capsule: { shape: capsule(0.06, 0.15), height: 0.06, turn: axisAngle([0, 1, 0], Math.PI / 2) },
  box: { shape: box(0.1, 0.15, 0.05), height: 0.05, turn: [1, 0, 0, 0] },
  cylinder: { shape: cylinder(0.1, 0.06), height: 0.06, turn: [1, 0, 0, 0] },
};

// States in which the body lies flat, leans, and stands on an edge, all in the plane by little.
function restingStates(kind, seed) {
  const { height, turn } = kShapes[kind];
  const random = new Random(seed);
  const tilts = [[1, 0, 0, 0], axisAngle([1, 0.3, 0], 0.004), axisAngle(random.direction(), 0.01)];
  return tilts.map((tilt, i) => ({
    q: [...random.vector(2, 1), height - 0.0004, ...multiply(tilt, turn)],
    v: [...random.vector(2, 0.5), -0.05 * i, ...random.vector(3, 1)],
    force: random.vector(6, 0.3),
  }));
}

function onPlane(kind, condim, more = {}) {
  const { shape, height, turn } = kShapes[kind];
  const { name = `${kind}_condim_${condim}`, material = {}, options, ground = {} } = more;
  const body = { friction: kFriction, condim, ...material };
  return {
    name,
    about: more.about ?? `a ${kind} that lands on a plane with condim ${condim}`,
    options,
    scene: new Scene().ground({ condim: 1, friction: kFriction, ...ground }).freeBody(kind, 1.5, shape, body),
    start: {
      q: [0, 0, height + 0.02, ...multiply(axisAngle([1, 0.5, 0], kind === 'sphere' ? 0 : 0.05), turn)],
      v: [0.4, -0.2, -0.3, 0.5, 1, 2],
    },
    stateTimes: [0.1, 0.5, 1],
    states: restingStates(kind, condim),
    ...more.scenario,
  };
}

// A cylinder on its side: two points, both far from the place where rounding chooses them.
const rolling = {
  name: 'cylinder_rolling',
  about: 'a cylinder that lands on its side and rolls',
  scene: new Scene().ground().freeBody('cylinder', 1.5, cylinder(0.1, 0.06), { friction: [0.5, 0.005, 0.0001] }),
  start: {
    q: [0, 0, 0.12, ...multiply(axisAngle([1, 0, 0], 0.05), axisAngle([1, 0, 0], Math.PI / 2))],
    v: [0.8, 0.1, 0, 0, 0, 1],
  },
  stateTimes: [0.1, 0.5, 1],
};

const kinds = Object.keys(kShapes);
const condims = [1, 3, 4, 6];

const frictions = [0.1, 0.5, 1, 2].map((mu) => ({
  name: `friction_${String(mu).replace('.', '_')}`,
  about: `a box that slides on a plane with friction ${mu}`,
  scene: new Scene()
    .ground({ friction: [mu, 0.005, 0.0001] })
    .freeBody('brick', 2, box(0.1, 0.1, 0.05), { friction: [mu, 0.005, 0.0001] }),
  start: { q: [0, 0, 0.0498, 1, 0, 0, 0], v: [1, 0.3, 0, 0, 0, 1] },
  stateTimes: [0, 0.1, 0.5, 1],
}));

const angle = Math.PI / 12;
const slope = axisAngle([0, 1, 0], angle);
const incline = {
  name: 'box_incline',
  about: 'a box on a slope of 15 degrees: it creeps',
  scene: new Scene()
    .geometry('ground', 'world', { kind: 'plane' }, { quaternion: slope })
    .freeBody('brick', 1, box(0.1, 0.1, 0.05)),
  start: { q: [0.0499 * Math.sin(angle), 0, 0.0499 * Math.cos(angle), ...slope], v: [0, 0, 0, 0, 0, 0] },
  stateTimes: [0, 0.1, 0.5, 1],
};

const soft = {
  solref: [0.06, 0.5],
  solimp: [0.5, 0.98, 0.01, 0.3, 3],
};

const softness = [
  onPlane('sphere', 3, {
    name: 'softness_mixed',
    about: 'solref and solimp of a sphere mixed with the defaults of the plane',
    material: soft,
  }),
  onPlane('box', 3, {
    name: 'softness_box',
    about: 'a soft box on a soft plane; friction of the two differs too',
    material: { ...soft, friction: [0.3, 0.005, 0.0001] },
    ground: { solref: [0.03, 1.2], solimp: [0.8, 0.9, 0.005, 0.6, 1], friction: [0.6, 0.005, 0.0001] },
  }),
  onPlane('sphere', 3, {
    name: 'softness_stiff',
    about: 'a time constant below two steps',
    material: { solref: [0.001, 1] },
    ground: { solref: [0.001, 1] },
  }),
  onPlane('sphere', 3, {
    name: 'softness_direct',
    about: 'solref gives stiffness and damping directly (negative numbers)',
    material: { solref: [-2000, -30] },
    ground: { solref: [-4000, -20] },
  }),
  onPlane('box', 3, {
    name: 'mix_weight',
    about: 'solmix 3 and 1, margins of both',
    material: { ...soft, solmix: 3, friction: [0.3, 0.005, 0.0001], margin: 0.002 },
    ground: { solref: [0.03, 1.2], margin: 0.001, friction: [0.6, 0.005, 0.0001] },
  }),
  onPlane('box', 3, {
    name: 'mix_priority',
    about: 'a slippery box whose priority is above that of the ground, which would rub and spin',
    material: { ...soft, priority: 2, friction: [0.3, 0.005, 0.0001], margin: 0.002 },
    ground: { condim: 6, priority: 1, margin: 0.001, friction: [0.9, 0.05, 0.01] },
  }),
  onPlane('box', 3, {
    name: 'contact_margin',
    about: 'margins of both geometries: rows before touching',
    material: { margin: 0.01 },
    ground: { margin: 0.004 },
  }),
  onPlane('box', 3, {
    name: 'impedance_ratio',
    about: 'friction ten times as hard as the normal (impratio 10)',
    options: { impratio: 10 },
  }),
];

const cones = condims.slice(1).flatMap((condim) => [
  onPlane('sphere', condim, {
    name: `elliptic_sphere_condim_${condim}`,
    about: `a sphere that lands, elliptic cone, condim ${condim}`,
    options: { cone: 'elliptic' },
  }),
  onPlane('box', condim, {
    name: `elliptic_box_condim_${condim}`,
    about: `a box that lands, elliptic cone, condim ${condim}, impratio 10`,
    options: { cone: 'elliptic', impratio: 10 },
  }),
]);

const runs = [
  onPlane('box', 3, {
    name: 'box_integrators',
    about: 'a box that lands, by every integrator',
    scenario: { integrators: ['Euler', 'RK4', 'implicit', 'implicitfast'], states: [], stateTimes: [0] },
  }),
];

export const contacts = [
  ...kinds.flatMap((kind) => condims.map((condim) => onPlane(kind, condim))),
  rolling,
  ...frictions,
  incline,
  ...softness,
  ...cones,
  ...runs,
];
