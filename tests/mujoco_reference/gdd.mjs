// SPDX-License-Identifier: Apache-2.0

// MuJoCo as the referee of goal directed dynamics: data/gdd_states holds states of the humanoid that
// gdd_benchmark has recorded, with the control that was found in each. MuJoCo's forward dynamics at
// that control tells the acceleration.

import { readdirSync, readFileSync } from 'node:fs';

import { robotScene } from './urdf.mjs';

const folder = new URL('../../data/gdd_states/', import.meta.url);

// A scenario for each file; its log has `gdd_` before the name.
export const gddScenarios = readdirSync(folder)
  .filter((file) => file.endsWith('.json'))
  .sort()
  .map((file) => {
    const recorded = JSON.parse(readFileSync(new URL(file, folder), 'utf8'));
    const states = recorded.states.map(({ q, v, control }) => ({ q, v, force: control }));
    return {
      name: `gdd_${file.replace('.json', '')}`,
      about: `accelerations at the controls of data/gdd_states/${file}`,
      scene: robotScene(recorded.model).ground(),
      timestep: recorded.timestep_s,
      joints: recorded.joints,
      states,
    };
  });

// What is logged of such a scenario.
export function judge(simulation, { joints, states }) {
  const dofs = simulation.dofs();
  // A floating joint, whose name is each engine's own, comes first.
  const order = (names) => names.slice(6).join();
  if (order(dofs) !== order(joints)) throw new Error(`joints ${order(dofs)}, recorded ${order(joints)}`);
  return states.map((state) => simulation.accelerationAt(state));
}
