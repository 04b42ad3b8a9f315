// SPDX-License-Identifier: Apache-2.0
// The picture of docs/robots.md, from the pages that its commands have written.
//
//   node robots.mjs FOLDER CHROMIUM PICTURES
//
// FOLDER holds the pages, robot_….html, and playwright-core; robots.png goes to PICTURES: the end of
// each run under the robot's name.

import { readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { Browser } from './pages.mjs';
import { still } from './stills.mjs';

const [folder, chromium, pictures] = process.argv.slice(2);
const browser = await Browser.launch(folder, chromium);
const tiles = [];
let last = null;
for (const file of readdirSync(folder).filter((name) => /^robot_.*[.]html$/.test(name)).sort()) {
  const name = file.slice(0, -'.html'.length);
  const { page, picture } = await still(browser, name, { forces: false }, 300);
  const image = (await picture(1e9)).toString('base64');
  tiles.push(`<figure><img src="data:image/png;base64,${image}" width="280">
    <figcaption>${name.replace('robot_', '')}</figcaption></figure>`);
  await last?.context().close();
  last = page;
}
await last.goto('about:blank');
await last.setViewportSize({ width: 840, height: 600 });
await last.setContent(`<style>
  body { margin: 0; display: grid; grid-template-columns: repeat(3, 280px); font: 14px sans-serif }
  figure { margin: 0 } figcaption { text-align: center; padding: 2px 0 8px }</style>${tiles.join('')}`);
writeFileSync(join(pictures, 'robots.png'), await last.screenshot({ fullPage: true }));
await browser.close();
