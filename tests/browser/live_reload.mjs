// SPDX-License-Identifier: Apache-2.0
// A live run whose model's file is changed: what is wrong with it is told, what is right begins anew.

import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { LiveProcess } from './live_process.mjs';

export async function testReload({ browser, simulator, folder, data, until }) {
  mkdirSync(join(folder, 'reload'), { recursive: true });
  const urdf = join(folder, 'reload/arm.urdf');
  const text = readFileSync(join(data, 'robots/arm.urdf'), 'utf8');
  writeFileSync(urdf, text);
  const run = await LiveProcess.start(simulator, folder, 'live_reload', [urdf]);
  const page = await browser.visit(run.address);
  const watcher = await browser.visit(run.address);
  const button = page.getByRole('button', { name: 'Reload model' });
  await until(page, () => window.softgauss.live.status.time > 0.5);

  // A file that cannot be read: its line is told, and the run goes on.
  writeFileSync(urdf, text.replace('</robot>', ''));
  await button.click();
  await until(page, () => window.softgauss.live.status.told.some((line) => line.includes('arm.urdf')));
  const { time } = await page.evaluate(() => window.softgauss.live.status);
  await until(page, (before) => window.softgauss.live.status.time > before + 0.2, time);

  // One that can: every page has it, from its start.
  writeFileSync(urdf, text.replace(/<robot name="[^"]*"/, '<robot name="another"'));
  await button.click();
  for (const each of [page, watcher]) {
    await until(each, () => window.softgauss?.header?.model === 'another' && window.softgauss.live.status?.loads === 2);
    await until(each, () => window.softgauss.live.status.steps > 10);
  }
  await page.close();
  await watcher.close();
  assert.equal(await run.stop(), 130);
  assert.equal(run.summary().model.name, 'another');
  assert.equal(run.out.match(/^live: /gm).length, 2);
}
