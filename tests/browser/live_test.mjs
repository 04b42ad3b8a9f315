// SPDX-License-Identifier: Apache-2.0
// A live run in Chromium: a hand is dragged by the mouse, and what came of it is read from the
// process, not from the page.
//
//   node live_test.mjs FOLDER CHROMIUM SIMULATE_GDD DATA

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { LiveProcess } from './live_process.mjs';
import { testFoot } from './live_foot.mjs';
import { testPlan } from './live_plan.mjs';
import { testReload } from './live_reload.mjs';
import { testStates } from './live_states.mjs';
import { Browser } from './pages.mjs';

const [folder, chromium, simulator, data] = process.argv.slice(2);
const browser = await Browser.launch(folder, chromium);

const status = (page) => page.evaluate(() => window.softgauss.live.status);
/** Waits for it; what the run was at is said where it does not come. */
const until = async (page, condition, argument) => {
  try {
    await page.waitForFunction(condition, argument, { polling: 50 });
  } catch (error) {
    console.error(`waited for ${condition} with ${argument}; the run: ${JSON.stringify(await status(page))}`);
    await browser.screenshot(page, 'live_waited').catch(() => {});
    throw error;
  }
};
const distance = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));
const stepsMore = async (page, count) => {
  const { steps } = await status(page);
  await until(page, (least) => window.softgauss.live.status.steps >= least, steps + count);
};

/** A press on the link, and a way to somewhere else; the button stays down. */
async function press(page, link, dx, dy, modifier = null) {
  const [x, y] = await page.evaluate((name) => window.softgauss.screenPosition(name), link);
  if (modifier) await page.keyboard.down(modifier);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 5; ++i) await page.mouse.move(x + (dx * i) / 5, y + (dy * i) / 5);
  if (modifier) await page.keyboard.up(modifier);
}

async function testHumanoid() {
  const args = [join(data, 'robots/humanoid.urdf'), '--timestep', '0.004'];
  const run = await LiveProcess.start(simulator, folder, 'live_humanoid', args);
  const page = await browser.visit(run.address);
  assert.equal(await page.locator('#live-state').textContent(), 'Live. Drag a link.');
  await stepsMore(page, 20);

  // Dragged: a goal appears, and the point of the hand comes to it.
  await press(page, 'right_hand', 60, -70);
  await until(page, () => window.softgauss.live.status.holding === 'drag 1');
  await stepsMore(page, 500); // two seconds after the mouse has come to rest
  const { steps: rested } = await status(page);
  await browser.screenshot(page, 'live_drag');
  const held = (await status(page)).goals.find(({ name }) => name === 'drag 1');
  assert.equal(held.link, 'right_hand');
  const drawn = await page.evaluate(() => window.softgauss.drawn().goals.filter(({ target }) => target));
  assert.equal(drawn.length, 1);
  assert.ok(distance(drawn[0].target, held.target) < 1e-3);
  await page.mouse.up();
  await until(page, () => window.softgauss.live.status.holding === '');

  // Pushed with shift, turned with control: it is recorded, and it stands.
  await press(page, 'torso', 40, 0, 'Shift');
  await stepsMore(page, 30);
  await page.mouse.up();
  await press(page, 'torso', 15, 0, 'Control');
  await stepsMore(page, 30);
  await page.mouse.up();
  await stepsMore(page, 400);

  // Paused: time stands; a step, a slider, a second back.
  await page.keyboard.press('Space');
  await until(page, () => window.softgauss.live.status.paused);
  const paused = await status(page);
  await page.waitForTimeout(300);
  assert.equal((await status(page)).steps, paused.steps);
  await page.getByRole('button', { name: 'One step' }).click();
  await until(page, (steps) => window.softgauss.live.status.steps === steps, paused.steps + 1);
  const before = await page.evaluate(() => window.softgauss.linkPose('left_hand').quaternion);
  await page.getByText('Joints', { exact: true }).click();
  await page.getByLabel('left_elbow in rad').fill('0.9');
  await until(
    page,
    (was) => Math.abs(window.softgauss.linkPose('left_hand').quaternion[0] - was) > 1e-3,
    before[0],
  );
  await page.getByRole('button', { name: 'One second back' }).click();
  await until(page, (time) => window.softgauss.time < time - 0.9, paused.time);
  assert.ok(distance(await page.evaluate(() => window.softgauss.linkPose('left_hand').quaternion), before) < 0.2);
  await page.keyboard.press('Space');
  await until(page, () => !window.softgauss.live.status.paused);

  // Goals are switched and weigh anew.
  const posture = page.locator('[data-goal="posture"]');
  await posture.getByLabel('stiffness').fill('60');
  await posture.getByLabel('stiffness').blur();
  await until(page, () => window.softgauss.live.status.goals.find(({ name }) => name === 'posture').stiffness === 60);

  // What was refused says why.
  await assert.rejects(
    page.evaluate(() => window.softgauss.ask({ advance: { count: 1 } })),
    /paused/,
  );

  // Files: goals that simulate_gdd reads, a picture.
  for (const [button, name] of [
    ['Save as goals.yaml', 'live_goals.yaml'],
    ['Save a picture of the view', 'live_picture.png'],
  ]) {
    const [file] = await Promise.all([
      page.waitForEvent('download'),
      page.getByRole('button', { name: button }).click(),
    ]);
    await file.saveAs(join(folder, name));
  }
  const read = spawnSync(simulator, [args[0], '--goals', join(folder, 'live_goals.yaml'), '--duration', '0.01', '--quiet']);
  assert.equal(read.status, 0, read.stderr.toString());
  assert.equal(readFileSync(join(folder, 'live_picture.png')).subarray(1, 4).toString(), 'PNG');

  // A second page watches, and takes over when the first has gone.
  const other = await browser.visit(run.address, { scheme: 'dark', width: 390, height: 800, touch: true });
  assert.match(await other.locator('#live-state').textContent(), /watches/);
  await page.close();
  await other.getByRole('button', { name: 'Take over' }).click();
  await until(other, () => window.softgauss.live.writes);
  // A finger drags as the mouse does.
  const [x, y] = await other.evaluate(() => window.softgauss.screenPosition('left_hand'));
  const touch = await other.context().newCDPSession(other);
  const finger = (type, points) => touch.send('Input.dispatchTouchEvent', { type, touchPoints: points });
  await finger('touchStart', [{ x, y }]);
  for (let i = 1; i <= 4; ++i) await finger('touchMove', [{ x: x + 6 * i, y: y - 6 * i }]);
  await until(other, () => window.softgauss.live.status.holding !== '');
  await browser.screenshot(other, 'live_phone_dark');
  await finger('touchEnd', []);
  await until(other, () => window.softgauss.live.status.holding === '');
  await stepsMore(other, 250);
  const { fallen } = await status(other);
  await other.close();
  assert.deepEqual(fallen, []);

  // What the process says of it.
  assert.equal(await run.stop(), 130);
  const summary = run.summary();
  assert.equal(summary.outcome, 'interrupted');
  const errors = run.log().map((row) => row['error:drag 1 [m]']);
  const grabbed = errors.findIndex(Number.isFinite);
  assert.ok(grabbed >= 0, 'the log has a goal');
  const dragged = errors.slice(grabbed, rested + 1).filter(Number.isFinite);
  assert.ok(dragged.some((error) => error > 0.03), 'it had a way to go');
  assert.ok(dragged.at(-1) < 0.03, `the hand came within ${1000 * dragged.at(-1)} mm`);
  for (const kind of ['grab', 'move', 'release', 'push', 'let_go', 'pause', 'advance', 'joint', 'back', 'goal'])
    assert.match(run.events(), new RegExp(`, ${kind}: \\{`), `${kind} is recorded`);

  // The same again, without a page.
  const again = join(folder, 'live_again.json');
  const played = spawnSync(simulator, [...args, '--play', run.file('record'), '--summary', again, '--quiet']);
  assert.equal(played.status, 0, played.stderr.toString());
  assert.equal(JSON.parse(readFileSync(again, 'utf8')).state_hash, summary.state_hash);
}

/** A dragged point that comes by minimum jerk; the panel's figures; what the page has seen, saved. */
async function testArm() {
  const run = await LiveProcess.start(simulator, folder, 'live_saved_run', [join(data, 'robots/arm.urdf')]);
  const page = await browser.visit(run.address, { width: 1000, height: 700 });
  // Some of the times that it shows; how many there are depends on the machine.
  await page.evaluate(() => {
    window.shown = new Set();
    setInterval(() => window.shown.add(window.softgauss.time), 100);
  });
  await page.getByLabel('A dragged point comes by').selectOption('jerk');
  await page.getByLabel('Duration of a minimum-jerk line in s').fill('0.4');
  await page.getByLabel('Duration of a minimum-jerk line in s').blur();
  await press(page, 'hand', 50, 30);
  await until(page, () => window.softgauss.live.status.holding === 'drag 1');
  await stepsMore(page, 500);
  const { goals, errors } = await status(page);
  const drag = goals.find(({ name }) => name === 'drag 1');
  assert.equal(drag.duration, 0.4);
  assert.equal(drag.weight_unit, 'kg');
  const error = errors.find(({ name }) => name === 'drag 1');
  assert.ok(error.unit === 'm' && error.value < 0.02, `${error.value} m`);
  assert.match(await page.locator('[data-goal="drag 1"]').innerText(), /drag 1: hand, in 0\.4 s/);
  await page.mouse.up();

  // Figures have names, curves and units.
  const figures = page.locator('.live-figures');
  assert.match(await figures.last().innerText(), /Step, median\s+\d+ µs/);
  const lines = figures.locator('canvas');
  assert.ok((await lines.count()) >= 12, 'a curve a figure');
  const median = figures.locator('dt[title="Step, median"] + canvas');
  assert.match(await median.getAttribute('title'), /… .* µs in the last minute/);
  await browser.screenshot(page, 'live_figures');

  await page.locator('#canvas').focus();
  await page.keyboard.press('Space');
  await until(page, () => window.softgauss.live.status.paused && !window.softgauss.playing);
  const expected = await page.evaluate(() => window.softgauss.linkPose('hand'));
  const shown = await page.evaluate(() => [...window.shown]);
  const [file] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Save replay page' }).click(),
  ]);
  assert.equal(file.suggestedFilename(), 'arm.html');
  await file.saveAs(join(folder, 'live_saved.html'));
  await page.close();
  assert.equal(await run.stop(), 130);

  // It needs no server, and shows what was seen.
  const saved = await browser.open('live_saved');
  const { frames, live, series } = await saved.evaluate(() => window.softgauss.header);
  assert.equal(live, undefined);
  const kept = await saved.evaluate((count) => {
    const { softgauss } = window;
    return Array.from({ length: count }, (_, i) => (softgauss.frame(i), softgauss.time));
  }, frames.count);
  assert.ok(shown.length > 2, `${shown.length} times were shown`);
  assert.deepEqual(shown.filter((time) => !kept.includes(time)), [], `of ${kept.length}`);
  assert.ok(series.groups.some(({ name }) => name === 'Goal errors'));
  await saved.evaluate(() => window.softgauss.seek(1e9));
  const seen = await saved.evaluate(() => window.softgauss.linkPose('hand'));
  assert.ok(distance(seen.position, expected.position) < 1e-6, `${seen.position}`);
  const marks = () => saved.evaluate(() => window.softgauss.drawn().goals.filter(({ target }) => target).length);
  await saved.waitForTimeout(100);
  assert.equal(await marks(), 0, 'the goal has ended');
  await browser.screenshot(saved, 'live_saved');
  await saved.close();
}

/** Goals of a task that act one after the other: the panel and the file have those in force. */
async function testGoals() {
  const run = await LiveProcess.start(simulator, folder, 'live_goals', [join(data, 'scenes/arm_picks.yaml')]);
  const page = await browser.visit(run.address, { width: 1000, height: 700 });
  await until(page, () => window.softgauss.live.status.time > 1.1);
  await page.locator('#canvas').focus();
  await page.keyboard.press('Space');
  await until(page, () => window.softgauss.live.status.paused);
  await until(page, () =>
    window.softgauss.live.status.goals.every(
      ({ name, acts }) =>
        document.querySelector(`[data-goal="${name}"] input[type="checkbox"]`)?.checked === acts,
    ),
  );
  const { goals } = await status(page);
  const [file] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Save as goals.yaml' }).click(),
  ]);
  // A weight is in the file where somebody has given it.
  const path = join(folder, 'live_task_goals.yaml');
  await file.saveAs(path);
  const lines = readFileSync(path, 'utf8').split('\n').filter((line) => line.startsWith('  - '));
  const kept = goals.filter(({ name, acts }) => acts && /^(reach|damping)/.test(name));
  assert.equal(lines.length, kept.length, lines.join('\n'));
  assert.match(lines[0], /quaternion: .*(start|end): /);
  kept.forEach((goal, i) => assert.equal(/[{ ]weight: /.test(lines[i]), !goal.weight_default, lines[i]));
  const read = spawnSync(simulator, [join(data, 'robots/picker.urdf'), '--goals', path, '--duration', '0.01', '--quiet']);
  assert.equal(read.status, 0, read.stderr.toString());
  await page.close();
  assert.equal(await run.stop(), 130);
}

async function testLooks() {
  const args = [join(data, 'robots/arm.urdf')];
  const run = await LiveProcess.start(simulator, folder, 'live_arm', args);
  for (const [name, options] of [
    ['live_desktop_light', {}],
    ['live_desktop_dark', { scheme: 'dark' }],
    ['live_phone_light', { width: 390, height: 800 }],
  ]) {
    const page = await browser.visit(run.address, options);
    await stepsMore(page, 100);
    await browser.screenshot(page, name);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    assert.ok(wide <= 0, `${name} is ${wide} pixels too wide`);
    await page.close();
  }
  assert.equal(await run.stop(), 130);
}

try {
  await testHumanoid();
  await testArm();
  await testGoals();
  await testStates({ browser, simulator, folder, data, status, until, stepsMore, distance });
  await testFoot({ browser, simulator, folder, data, status, until, stepsMore, press });
  await testPlan({ browser, simulator, folder, data, until, stepsMore, distance });
  await testReload({ browser, simulator, folder, data, until });
  await testLooks();
} catch (error) {
  LiveProcess.killAll();
  await browser.close();
  throw error;
}
await browser.close();
assert.deepEqual(browser.complaints.filter((text) => !/Failed to load resource/.test(text)), []);
console.log('live runs are dragged, pushed, paused and played again');
