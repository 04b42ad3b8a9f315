// SPDX-License-Identifier: Apache-2.0
// The pictures of docs/guide/recipes.md and plans.md, from the pages that its commands have written; and the moving
// picture of the README, an animated PNG of one of them.
//
//   node recipes.mjs FOLDER CHROMIUM PICTURES
//
// FOLDER holds the pages, recipe_….html, and playwright-core; pictures go to PICTURES.

import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { animatedPng } from './animated_png.mjs';
import { Browser } from './pages.mjs';
import { still } from './stills.mjs';

const [folder, chromium, pictures] = process.argv.slice(2);
const shots = [
  { name: 'stand', time: 1 },
  { name: 'reach', time: 2 },
  { name: 'push', time: 4, view: { preset: 'side' } },
  { name: 'pick', time: 3.7, view: { forces: false } },
  { name: 'grip', time: 2, view: { forces: false } },
  { name: 'steps', time: 3.88, view: { preset: 'front' } },
  { name: 'balance', time: 0.75, view: { preset: 'side' } },
  { name: 'swing', time: 0.4, frame: 'home' },
  { name: 'rise', time: 0.25, frame: 'home' },
  { name: 'hop', time: 1.3, frame: 'side' },
  { name: 'ahead', time: 0.6, frame: 'home' },
  { name: 'box', time: 0.6, frame: 'home' },
  { name: 'turn', time: 1, frame: 'home', view: { forces: false } },
];
const MOVING = { name: 'reach', from: 0, to: 1.2, frames: 12, width: 360 };

const browser = await Browser.launch(folder, chromium);

for (const { name, time, view: settings, frame } of shots) {
  const { page, picture } = await still(browser, `recipe_${name}`, settings);
  if (frame) {  // where everything is then
    await picture(time);
    await page.evaluate((preset) => window.softgauss.setView({ preset }), frame);
  }
  writeFileSync(join(pictures, `recipe_${name}.png`), await picture(time));
  await page.context().close();
}

const { page, picture } = await still(browser, `recipe_${MOVING.name}`, {}, MOVING.width);
const frames = [];
for (let i = 0; i < MOVING.frames; ++i)
  frames.push(await picture(MOVING.from + ((MOVING.to - MOVING.from) * i) / (MOVING.frames - 1)));
await page.context().close();
const step = ((MOVING.to - MOVING.from) / (MOVING.frames - 1)) * 1000;
writeFileSync(join(pictures, 'moving.png'), animatedPng(frames, step, 1500));

await browser.close();
if (browser.complaints.length) throw new Error(browser.complaints.join('\n'));
