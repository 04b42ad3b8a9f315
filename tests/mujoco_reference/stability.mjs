// SPDX-License-Identifier: Apache-2.0

// Runs the hard cases that `stability_report --export FOLDER` has written, and writes q and v of
// every step beside them, as doubles, for `stability_report --measure FOLDER`.
//
//   stability.mjs MODULES FOLDER
//
// A run ends where MuJoCo warns. Its own defaults but for the integrator.

import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const kIntegrators = ['Euler', 'discrete']; // the first is the default

const [modules, folder] = process.argv.slice(2);
const entry = join(resolve(modules), '@mujoco/mujoco', 'mujoco.js');
const mujoco = await (await import(pathToFileURL(entry))).default();

function run(mjcf, { q, v, steps }, integrator) {
  const chosen = mjcf.replace('<option ', `<option integrator="${integrator}" `);
  if (chosen === mjcf) throw new Error('found no <option>');
  // Numbers of rows and contacts are for MuJoCo 2, which has them in place of memory.
  const model = mujoco.MjModel.from_xml_string(chosen.replace(/<size [^>]*>/, '<size memory="100M"/>'));
  const data = new mujoco.MjData(model);
  data.qpos.set(q);
  data.qvel.set(v);
  const size = model.nq + model.nv;
  const states = new Float64Array(steps * size);
  const warned = () => {
    for (let i = 0; i < data.warning.size(); ++i) if (data.warning.get(i).number > 0) return true;
    return false;
  };
  let done = 0;
  while (done < steps) {
    mujoco.mj_step(model, data);
    if (warned()) break;
    states.set(data.qpos, done * size);
    states.set(data.qvel, done * size + model.nq);
    ++done;
  }
  data.delete();
  model.delete();
  return states.subarray(0, done * size);
}

for (const file of readdirSync(folder).filter((name) => name.endsWith('.xml'))) {
  const name = file.slice(0, -'.xml'.length);
  const mjcf = readFileSync(join(folder, file), 'utf8');
  const start = JSON.parse(readFileSync(join(folder, `${name}.json`), 'utf8'));
  for (const integrator of kIntegrators) {
    const states = run(mjcf, start, integrator);
    writeFileSync(join(folder, `${name}_${integrator}.bin`), new Uint8Array(states.buffer, 0, states.byteLength));
    console.log(`${name} ${integrator}: ${states.length === 0 ? 'no step' : 'done'}`);
  }
}
writeFileSync(join(folder, 'version.txt'), `${mujoco.mj_versionString()}\n`);
