// SPDX-License-Identifier: Apache-2.0

// The table of docs/mujoco_parity.md, from the figures that the parity tests leave:
//
//   parity_tests --gtest_output=json:figures.json; table.mjs figures.json

import { readFileSync } from 'node:fs';

const columns = ['totals', 'M', 'bias', 'points', 'rows', 'J', 'D', 'a_ref', 'f', 'a', 'a_elsewhere', 'inverse', 'run', 'half_step'];
const heads = ['totals', 'M', 'b', 'points', 'rows', 'J', 'D', 'a_ref', 'f', 'a', 'a, our points', 'inverse', 'run', 'h against h/2'];

const figures = new Map();
for (const suite of JSON.parse(readFileSync(process.argv[2], 'utf8')).testsuites)
  for (const test of suite.testsuite) {
    const name = test.name.split('/')[1];
    if (name) figures.set(name, { ...figures.get(name), ...test });
  }

console.log(`| scenario | ${heads.join(' | ')} |`);
console.log(`|---|${columns.map(() => '---|').join('')}`);
for (const [name, row] of figures) {
  const cells = columns.map((column) => (row[column] === '0.0e+00' ? '0' : (row[column] ?? '')));
  console.log(`| ${name} | ${cells.join(' | ')} |`);
}
