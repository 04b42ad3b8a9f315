// SPDX-License-Identifier: Apache-2.0

// All scenarios. Each has
//   name, about      file name of its log, and one sentence
//   scene            see scene.mjs
//   start            {q, v, force} of its trajectories; what is left out is qpos0 or 0. With
//                    hold: true, force also balances the bias of the start at scalar joints.
//   states           further states to be evaluated; they may have wrenches besides, a list of
//                    {link, force, moment} about origins of links, in world axes
// and what else record.mjs lists as defaults.

import { contacts } from './scenarios/contacts.mjs';
import { joints } from './scenarios/joints.mjs';
import { loops } from './scenarios/loops.mjs';
import { pairings } from './scenarios/pairs.mjs';
import { robots } from './scenarios/robots.mjs';
import { trees } from './scenarios/trees.mjs';

const written = [...trees, ...joints, ...loops, ...contacts, ...pairings, ...robots];

// Whether something in the scene may touch something else, with friction.
const rubs = ({ geometries }) =>
  geometries.length > 1 && geometries.some((geometry) => (geometry.condim ?? 3) > 1);

// Every scenario whose contacts rub comes with elliptic cones too.
const names = new Set(written.map(({ name }) => name));
const elliptic = written
  .filter(({ name, scene }) => rubs(scene) && !names.has(`elliptic_${name}`) && !name.startsWith('elliptic_'))
  .map((scenario) => ({
    ...scenario,
    name: `elliptic_${scenario.name}`,
    about: `${scenario.about}; elliptic cones`,
    options: { ...scenario.options, cone: 'elliptic' },
  }));

// Some with the exact diagonal of J M⁻¹ Jᵀ in place of constant inverse weights: every kind of row.
const exact = [...written, ...elliptic]
  .filter(({ name }) =>
    [
      'pendulum_limit',
      'coupled_pair',
      'weld_hanging',
      'connect_hanging',
      'chain_dry_friction',
      'box_condim_1',
      'box_condim_6',
      'humanoid_lying',
      'elliptic_box_condim_6',
      'elliptic_hand_fingers',
    ].includes(name),
  )
  .map((scenario) => ({
    ...scenario,
    name: `exact_${scenario.name}`,
    about: `${scenario.about}; exact diagonal of J inv(M) J'`,
    options: { ...scenario.options, diagexact: true },
  }));

export const scenarios = [...written, ...elliptic, ...exact];
