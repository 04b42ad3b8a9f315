// SPDX-License-Identifier: Apache-2.0
// playwright-core from the npm registry, in one version with one checksum; npm is not needed.
//
//   node fetch_playwright.mjs FOLDER
//
// It comes to FOLDER/package. Nothing is fetched when it is there already.

import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

const VERSION = '1.57.0';
const SHA512 =
  'agTcKlMw/mjBWOnD6kFZttAAGHgi/Nw0CZ2o6JqWSbMlI219lAFLZZCyqByTsvVAJq5XA5H8cA6PrvBRpBWEuQ==';
const URL = `https://registry.npmjs.org/playwright-core/-/playwright-core-${VERSION}.tgz`;

const folder = process.argv[2];
const manifest = join(folder, 'package', 'package.json');
if (!existsSync(manifest) || JSON.parse(readFileSync(manifest, 'utf8')).version !== VERSION) {
  const fail = (reason) => {
    console.log(`${URL}: ${reason}`);
    process.exit(1);
  };
  const response = await fetch(URL).catch((error) => fail(error.cause?.message ?? error.message));
  if (!response.ok) fail(`HTTP ${response.status}`);
  const archive = Buffer.from(await response.arrayBuffer());
  if (createHash('sha512').update(archive).digest('base64') !== SHA512) fail('wrong SHA-512');
  const file = join(folder, 'playwright-core.tgz');
  writeFileSync(file, archive);
  execFileSync('tar', ['-xzf', file, '-C', folder]);
}
