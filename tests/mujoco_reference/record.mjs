// SPDX-License-Identifier: Apache-2.0

// Writes data/reference/<scenario>.json, what MuJoCo computes for each scenario.
//
//   record.mjs MODULES REFERENCE [--check] [NAME…]
//
// MODULES is the folder into which npm has put MuJoCo, REFERENCE that of the logs. With --check
// nothing is written; the exit code is 1 when a log is not what would be written.

import { existsSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

import { gddScenarios, judge } from './gdd.mjs';
import { jsonText } from './json_text.mjs';
import { toMjcf } from './mjcf.mjs';
import { Random } from './random.mjs';
import { scenarios } from './scenarios.mjs';
import { kSolver, Simulation } from './simulation.mjs';

const kPackage = '@mujoco/mujoco';
const kLargestLog = 500000;

const kDefaults = {
  seed: 1,
  options: {},
  timestep: 0.002,
  duration: 1,
  every: 0.05, // samples of a trajectory [s]
  integrators: ['Euler'],
  settle: 0, // free run before the start [s]
  states: [], // to be evaluated, besides
  stateTimes: [0], // those on the trajectory, multiples of `every`
};

// The log of a scenario.
function record(mujoco, given) {
  const scenario = { ...kDefaults, ...given };
  const { name, about, seed, scene, timestep, duration, every, integrators } = scenario;
  const options = { gravity: [0, 0, -9.81], cone: 'pyramidal', impratio: 1, ...scenario.options };
  const mjcf = toMjcf(name, scene, { timestep, ...options }, kSolver);
  const simulation = new Simulation(mujoco, mjcf);

  const random = new Random(seed);
  const dofs = simulation.dofs();
  const zero = dofs.map(() => 0);
  const complete = ({ q, v, force, wrenches } = {}) => ({
    q: q ?? simulation.initialPosition(),
    v: v ?? zero,
    force: force ?? zero,
    wrenches,
  });
  let start = complete(scenario.start);
  if (scenario.start?.hold) start.force = simulation.holdingForce(start);
  if (scenario.settle > 0) {
    const end = simulation.trajectory(start, 'Euler', timestep, scenario.settle, scenario.settle);
    start = { ...start, q: end.q.at(-1), v: end.v.at(-1) };
  }

  // Half the step shows how far a run is from its own limit.
  const run = (integrator, h) => simulation.trajectory(start, integrator, h, duration, every);
  const trajectories = integrators.flatMap((integrator) => [
    run(integrator, timestep),
    run(integrator, timestep / 2),
  ]);
  const onTrajectory = scenario.stateTimes.map((time) => {
    const sample = Math.round(time / every);
    return { q: trajectories[0].q[sample], v: trajectories[0].v[sample], force: start.force };
  });
  const states = [...onTrajectory, ...scenario.states.map(complete)].map((state) =>
    simulation.evaluate(state, random.vector(dofs.length, 3)),
  );
  const log = {
    name,
    about,
    recorded_with: { engine: 'MuJoCo', version: mujoco.mj_versionString(), package: kPackage, ...kSolver },
    seed,
    options: { timestep, ...options },
    scene,
    dofs,
    applied_force: start.force,
    states,
    trajectories,
  };
  simulation.delete();
  return `${jsonText(log)}\n`;
}

// The log of states that goal directed dynamics has recorded.
function recordGdd(mujoco, { name, about, scene, timestep, ...recorded }) {
  const options = { timestep, gravity: [0, 0, -9.81], cone: 'pyramidal', impratio: 1 };
  const simulation = new Simulation(mujoco, toMjcf(name, scene, options, kSolver));
  const log = {
    name,
    about,
    recorded_with: { engine: 'MuJoCo', version: mujoco.mj_versionString(), package: kPackage, ...kSolver },
    options,
    states: judge(simulation, recorded),
  };
  simulation.delete();
  return `${jsonText(log)}\n`;
}

const [modules, reference, ...rest] = process.argv.slice(2);
const check = rest.includes('--check');
const names = rest.filter((word) => word !== '--check');
const all = [
  ...scenarios.map((scenario) => ({ scenario, write: record })),
  ...gddScenarios.map((scenario) => ({ scenario, write: recordGdd })),
];
for (const name of names)
  if (!all.some(({ scenario }) => scenario.name === name)) throw new Error(`no scenario ${name}`);

const entry = join(resolve(modules), kPackage, 'mujoco.js');
const mujoco = await (await import(pathToFileURL(entry))).default();

let wrong = 0;
for (const { scenario, write } of all) {
  if (names.length && !names.includes(scenario.name)) continue;
  const file = join(reference, `${scenario.name}.json`);
  let text;
  try {
    text = write(mujoco, scenario);
  } catch (error) {
    throw new Error(`scenario ${scenario.name}: ${error.message ?? error}`);
  }
  if (text.length > kLargestLog) throw new Error(`${file} would have ${text.length} bytes`);
  const same = existsSync(file) && readFileSync(file, 'utf8') === text;
  if (same) continue;
  if (check) {
    ++wrong;
    console.log(`${file} is not what the recorder gives`);
  } else {
    writeFileSync(file, text);
    console.log(`${file} ${text.length} bytes`);
  }
}
const known = new Set(all.map(({ scenario }) => `${scenario.name}.json`));
for (const file of names.length ? [] : readdirSync(reference)) {
  if (known.has(file)) continue;
  ++wrong;
  console.log(`${join(reference, file)} belongs to no scenario`);
}
process.exitCode = wrong ? 1 : 0;
