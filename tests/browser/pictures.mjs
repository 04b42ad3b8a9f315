// SPDX-License-Identifier: Apache-2.0
// The pictures of README and docs, from pages of real runs.
//
//   node pictures.mjs FOLDER CHROMIUM PICTURES
//
// FOLDER holds humanoid, arm and hand as .html, and playwright-core; pictures go to PICTURES.

import { join } from 'node:path';
import { Browser } from './pages.mjs';

const [folder, chromium, pictures] = process.argv.slice(2);
const shots = [
  { name: 'humanoid', time: 0.35, scheme: 'dark', view: { groups: ['Contact normal forces', 'Goal errors', 'Controls'] } },
  { name: 'hand', time: 1, scheme: 'light', view: { preset: 'home' } },
  { name: 'arm', time: 0.66, scheme: 'light', view: { path: true, groups: ['Joint positions', 'Goal errors'] }, select: 'hand' },
];

const browser = await Browser.launch(folder, chromium);
for (const { name, time, scheme, view, select } of shots) {
  const page = await browser.open(name, { width: 1280, height: 760, scheme });
  await page.evaluate(
    ([t, settings, link]) => {
      window.softgauss.setView(settings);
      window.softgauss.seek(t);
      if (link) window.softgauss.select(link);
    },
    [time, view, select],
  );
  await page.waitForTimeout(1500);
  await page.screenshot({ path: join(pictures, `${name}.png`) });
  await page.context().close();
}
await browser.close();
if (browser.complaints.length) throw new Error(browser.complaints.join('\n'));
