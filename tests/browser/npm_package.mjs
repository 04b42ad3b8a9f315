// SPDX-License-Identifier: Apache-2.0
// A package of the npm registry, in one version with one checksum; npm is not needed.
//
//   node npm_package.mjs FOLDER NAME VERSION SHA512 [NAME VERSION SHA512]…
//
// Each comes to FOLDER/NAME. Nothing is fetched that is there already.

import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

async function fetchPackage(folder, name, version, sha512) {
  const target = join(folder, name);
  const manifest = join(target, 'package.json');
  if (existsSync(manifest) && JSON.parse(readFileSync(manifest, 'utf8')).version === version) return;
  const url = `https://registry.npmjs.org/${name}/-/${name.split('/').at(-1)}-${version}.tgz`;
  const fail = (reason) => {
    console.log(`${url}: ${reason}`);
    process.exit(1);
  };
  const response = await fetch(url).catch((error) => fail(error.cause?.message ?? error.message));
  if (!response.ok) fail(`HTTP ${response.status}`);
  const archive = Buffer.from(await response.arrayBuffer());
  if (createHash('sha512').update(archive).digest('base64') !== sha512) fail('wrong SHA-512');
  mkdirSync(target, { recursive: true });
  const file = join(target, 'archive.tgz');
  writeFileSync(file, archive);
  execFileSync('tar', ['-xzf', file, '--strip-components=1', '-C', target]);
}

const [folder, ...packages] = process.argv.slice(2);
for (let i = 0; i < packages.length; i += 3) await fetchPackage(folder, ...packages.slice(i, i + 3));
