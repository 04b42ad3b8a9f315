// SPDX-License-Identifier: Apache-2.0
// Makes replay_page.html, one file, from the sources in this folder; build.sh calls it.
//
//   node build.mjs MODULES OUTPUT
//
// MODULES is the node_modules folder that `npm ci` filled from package-lock.json. The same sources
// give the same bytes. The first comment of the page holds two sums, as check_page.cmake has them:
// the SHA-256 over the sources, that is of the lines "<sha256>  <path>", one a file, in the order
// of the paths; and the SHA-256 of all of the page that follows the line of the sums.

import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, relative, resolve, sep } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

const here = fileURLToPath(new URL('.', import.meta.url));
const [modules, output] = process.argv.slice(2).map((path) => resolve(path));
if (!output) throw new Error('usage: node build.mjs MODULES OUTPUT');
const esbuild = createRequire(pathToFileURL(join(modules, 'x')))('esbuild');

function sources(folder = here) {
  return readdirSync(folder, { withFileTypes: true }).flatMap((entry) =>
    entry.isDirectory() ? sources(join(folder, entry.name)) : [join(folder, entry.name)],
  );
}

const sha256 = (data) => createHash('sha256').update(data).digest('hex');

function sourceHash() {
  const paths = sources()
    .map((file) => relative(here, file).split(sep).join('/'))
    .sort();
  return sha256(
    paths.map((path) => `${sha256(readFileSync(join(here, path)))}  ${path}\n`).join(''),
  );
}

function bundle(entry, options) {
  const { outputFiles } = esbuild.buildSync({
    entryPoints: [join(here, entry)],
    nodePaths: [modules],
    bundle: true,
    minify: true,
    write: false,
    legalComments: 'none',
    logLevel: 'warning',
    absWorkingDir: here,
    ...options,
  });
  return outputFiles[0].text.trim();
}

function libraries() {
  const names = Object.keys(
    JSON.parse(readFileSync(join(here, 'package.json'), 'utf8')).dependencies,
  );
  return names.map((name) => {
    const folder = join(modules, name);
    const { version, license } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
    return { name, version, license, text: readFileSync(join(folder, 'LICENSE'), 'utf8').trim() };
  });
}

const script = bundle('src/main.js', { format: 'iife', target: ['es2022'] });
const style = bundle('style.css', { target: ['chrome111', 'firefox113', 'safari16.4'] });
const hash = (text) => `'sha256-${createHash('sha256').update(text).digest('base64')}'`;
const parts = {
  // Nothing may be fetched; only this script and this style count.
  CSP: [
    "default-src 'none'",
    `script-src ${hash(script)}`,
    `style-src ${hash(style)}`,
    'img-src data:',
    "base-uri 'none'",
    "form-action 'none'",
  ].join('; '),
  STYLE: style,
  SCRIPT: script,
  LICENCES: libraries()
    .map(({ name, version, text }) => `${name} ${version}\n\n${text}`)
    .join('\n\n\n'),
  TITLE: '@@SOFTGAUSS_TITLE@@',
  RUN: '@@SOFTGAUSS_RUN@@',
  OTHER_RUN: '@@SOFTGAUSS_OTHER_RUN@@',
};
const body = readFileSync(join(here, 'index.html'), 'utf8').replace(/@(\w+)@/g, (whole, name) => {
  if (parts[name] === undefined) throw new Error(`index.html: there is no part ${whole}`);
  return parts[name];
});
const rest = `
It holds these libraries:

${parts.LICENCES}
-->
${body}`;
const page = `<!doctype html>
<!--
SPDX-License-Identifier: Apache-2.0
Made from io/replay/page by "./dev page"; do not edit.
SHA-256 of the sources: ${sourceHash()}
SHA-256 of what follows this line: ${sha256(rest)}
${rest}`;

for (const place of [parts.TITLE, parts.RUN, parts.OTHER_RUN])
  if (page.split(place).length !== 2) throw new Error(`the page must hold ${place} exactly once`);
if (parts.LICENCES.includes('--')) throw new Error('a licence ends the comment that it is in');
writeFileSync(output, page);
console.log(`${output}: ${(page.length / 1024).toFixed(0)} KiB`);
