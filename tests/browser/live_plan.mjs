// SPDX-License-Identifier: Apache-2.0
// A plan that is made anew while it runs: its target is dragged, the run goes back, and both are
// played again.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { LiveProcess } from './live_process.mjs';

const PLAN = (data) => `robots:
  - urdf: ${join(data, 'robots/arm.urdf')}
plan:
  step: 0.05
  knots: 20
  running: {velocity: 0.02, points: {hand: {target: [0.5, 0.3, 0.5], weight: 10}}}
  final: {velocity: 20, points: {hand: {target: [0.5, 0.3, 0.5], weight: 2000}}}
  effort: 1e-3
`;
const TARGET = [0.5, 0.3, 0.5];

export async function testPlan({ browser, simulator, folder, data, until, stepsMore, distance }) {
  const scene = join(folder, 'live_plan.yaml');
  writeFileSync(scene, PLAN(data));
  const run = await LiveProcess.start(simulator, folder, 'live_planned', [scene, '--mpc']);
  const page = await browser.visit(run.address, { width: 1000, height: 700 });
  assert.equal(await page.locator('#live-state').textContent(), 'Live. Drag a target or a link.');
  const mark = await page.evaluate(() => window.softgauss.header.goals.findIndex(({ name }) => name === 'plan hand'));
  const place = () => page.evaluate((i) => window.softgauss.drawn().goals[i], mark);
  const arrives = async () => {
    await until(
      page,
      (i) => {
        const { point, target } = window.softgauss.drawn().goals[i];
        return Math.hypot(...point.map((x, k) => x - target[k])) < 0.01;
      },
      mark,
    );
    await stepsMore(page, 200);
    return place();
  };
  assert.ok(distance((await arrives()).target, TARGET) < 1e-6);

  // The mouse takes the place, and the hand follows.
  const [x, y] = await page.evaluate((i) => window.softgauss.markPosition(i), mark);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 20; ++i) await page.mouse.move(x - 5 * i, y + 3 * i);
  await page.mouse.up();
  await stepsMore(page, 100);
  const there = await arrives();
  const way = distance(there.target, TARGET);
  assert.ok(way > 0.05, `the target was moved by ${way} m`);
  assert.ok(distance(there.point, there.target) < 0.01, `${there.point} of ${there.target}`);
  await browser.screenshot(page, 'live_plan');

  // Back at the start it is planned anew, for the target that the file has.
  await page.locator('#canvas').focus();
  await page.keyboard.press('Home');
  await until(page, () => window.softgauss.live.status.told.some((line) => /planned from here/.test(line)));
  assert.ok(distance((await arrives()).target, TARGET) < 1e-6);
  await page.close();
  assert.equal(await run.stop(), 130);
  for (const kind of ['target', 'reset']) assert.match(run.events(), new RegExp(`, ${kind}: \\{`));

  const again = join(folder, 'live_planned_again.json');
  const played = spawnSync(simulator, [scene, '--mpc', '--play', run.file('record'), '--summary', again, '--quiet']);
  assert.equal(played.status, 0, played.stderr.toString());
  assert.equal(JSON.parse(readFileSync(again, 'utf8')).state_hash, run.summary().state_hash);
}
