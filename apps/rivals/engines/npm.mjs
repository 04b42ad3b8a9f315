// SPDX-License-Identifier: Apache-2.0
// One run of an engine from npm: PACKAGES ENGINE SCENE.json STATES H [--least s] [--most s] [key=value…],
// where PACKAGES is a node_modules. Reads, writes and prints what run.cpp does; of times nothing, for
// WebAssembly's say little of an engine.
import {closeSync, openSync, readFileSync, writeSync} from 'node:fs';
import {resolve} from 'node:path';

import {makeJolt} from './npm_jolt.mjs';
import {makeMujoco} from './npm_mujoco.mjs';
import {makeRapier} from './npm_rapier.mjs';

const engines = {mujoco: makeMujoco, rapier: makeRapier, jolt: makeJolt};
const versions = {
  mujoco: ['MuJoCo', '@mujoco/mujoco'],
  rapier: ['Rapier', '@dimforge/rapier3d-compat'],
  jolt: ['Jolt.js', 'jolt-physics']
};

function read(args) {
  const plain = [], settings = {};
  let most = 60;
  for (let i = 0; i < args.length; ++i) {
    if (args[i] === '--least') ++i;
    else if (args[i] === '--most') most = Number(args[++i]);
    else if (plain.length < 5) plain.push(args[i]);
    else settings[args[i].split('=')[0]] = args[i].split('=')[1];
  }
  const [packages, engine, scene, states, h] = plain;
  return {packages: resolve(packages), engine, scene: JSON.parse(readFileSync(scene, 'utf8')), states, h: Number(h), most, settings};
}

// States are {position, orientation (w first), velocity, angularVelocity}, of the scene's bodies.
const rowOf = (s) => [...s.position, ...s.orientation, ...s.velocity, ...s.angularVelocity];
const isSane = (states) => states.every((s) => rowOf(s).every((x) => Math.abs(x) < 1e6));

function cpuSeconds() {
  const {user, system} = process.cpuUsage();
  return 1e-6 * (user + system);
}

async function main() {
  const {packages, engine, scene, states, h, most, settings} = read(process.argv.slice(2));
  const [name, folder] = versions[engine];
  const version = JSON.parse(readFileSync(`${packages}/${folder}/package.json`, 'utf8')).version;
  const out = {version: `${name} ${version} (WebAssembly)`};
  try {
    const world = await engines[engine](packages, scene, h, settings);
    out.mass = world.mass();
    const energy = world.kineticEnergy();
    if (energy !== undefined) out.kinetic_energy = energy;
    const file = openSync(states, 'w');
    const write = (rows) => writeSync(file, new Uint8Array(new Float64Array(rows.flatMap(rowOf)).buffer));
    const steps = Math.round(scene.sample / h), samples = Math.round(scene.duration / scene.sample), begin = cpuSeconds();
    write(world.state());
    out.end = 'done';
    for (let k = 1; k <= samples && out.end === 'done'; ++k) {
      let ok = true;
      for (let i = 0; i < steps && ok; ++i) ok = world.step();
      const now = world.state();
      out.time = k * scene.sample;
      if (!ok || !isSane(now)) out.end = 'diverged';
      else write(now);
      if (out.end === 'done' && cpuSeconds() - begin > most && k < samples) out.end = 'late';
    }
    closeSync(file);
  } catch (e) {
    if (!(e instanceof Error) || !e.message.startsWith('cannot express')) throw e;
    Object.assign(out, {end: 'cannot express', why: e.message.slice('cannot express: '.length)});
  }
  console.log(JSON.stringify(out));
  process.exit(0);  // engines keep threads
}
main().catch((e) => {
  console.error(String(e?.stack ?? e));
  process.exit(2);
});
