// SPDX-License-Identifier: Apache-2.0
// A quadruped whose foot is dragged by the mouse goes on standing on the other three.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import { LiveProcess } from './live_process.mjs';

const BENT = ['fl', 'fr', 'hl', 'hr'].flatMap((leg) => [`${leg}_swing=-0.8`, `${leg}_knee=1.6`]).join(',');

export async function testFoot({ browser, simulator, folder, data, status, until, stepsMore, press }) {
  const run = await LiveProcess.start(simulator, folder, 'live_foot', [
    join(data, 'plans/quadruped.urdf'),
    '--q0',
    BENT,
  ]);
  const page = await browser.visit(run.address, { width: 1000, height: 700 });
  await stepsMore(page, 300);
  const pose = (link) => page.evaluate((name) => window.softgauss.linkPose(name).position, link);
  const trunk = await pose('trunk');

  await press(page, 'fr_shank', 0, -45);
  await until(page, () => window.softgauss.live.status.holding === 'drag 1');
  await stepsMore(page, 1000); // two seconds in which it stands on three feet
  await browser.screenshot(page, 'live_foot');
  const { contacts, fallen, errors } = await status(page);
  assert.equal(contacts, 3);
  assert.deepEqual(fallen, []);
  const left = errors.find(({ name }) => name === 'drag 1').value;
  assert.ok(left < 0.005, `the foot is ${1000 * left} mm from the mouse`);
  assert.ok(Math.abs((await pose('trunk'))[2] - trunk[2]) < 0.03, 'as high as it stood');
  await page.mouse.up();
  await until(page, () => window.softgauss.live.status.contacts === 4);
  await stepsMore(page, 500);
  assert.deepEqual((await status(page)).fallen, []);
  await page.close();
  assert.equal(await run.stop(), 130);
}
