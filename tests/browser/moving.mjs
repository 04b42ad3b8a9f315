// SPDX-License-Identifier: Apache-2.0
// The view of a run as single pictures, so many a second of the run.
//
//   node moving.mjs FOLDER CHROMIUM NAME RATE PICTURES
//
// FOLDER holds NAME.html and playwright-core; 0000.png and so on go to PICTURES.

import { join } from 'node:path';
import { Browser } from './pages.mjs';

const [folder, chromium, name, rate, pictures] = process.argv.slice(2);
const browser = await Browser.launch(folder, chromium);
const page = await browser.open(name, { width: 480, height: 400 });
// The view alone, from where all of the run is seen.
const duration = await page.evaluate(() => {
  for (const id of ['top', 'transport', 'toolbar']) document.getElementById(id).hidden = true;
  softgauss.setView({ links: false, plots: false, com: false, cop: false, forceScale: 0.6 });
  softgauss.seek(0.4 * softgauss.header.duration);
  softgauss.setView({ preset: 'home' });
  return softgauss.header.duration;
});
for (let i = 0; i < duration * Number(rate); ++i) {
  await page.evaluate(async (time) => {
    softgauss.seek(time);
    for (let k = 0; k < 2; ++k) await new Promise(requestAnimationFrame);
  }, i / Number(rate));
  await page.screenshot({ path: join(pictures, `${String(i).padStart(4, '0')}.png`) });
}
await browser.close();
if (browser.complaints.length) throw new Error(browser.complaints.join('\n'));
