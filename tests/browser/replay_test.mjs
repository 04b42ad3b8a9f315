// SPDX-License-Identifier: Apache-2.0
// The replay page as a person uses it, in Chromium:
//
//   node replay_test.mjs FOLDER CHROMIUM ROBOTS
//
// FOLDER holds humanoid, arm, hand, long and failed as .html and .csv, and playwright-core;
// screenshots go there.

import assert from 'node:assert/strict';
import { statSync } from 'node:fs';
import { join } from 'node:path';
import { Truth } from './drawn.mjs';
import { misplacedButtons } from './layout.mjs';
import { difference, linkPoses, readLog, readUrdf } from './kinematics.mjs';
import { Browser, plotPoint } from './pages.mjs';

const [folder, chromium, robots] = process.argv.slice(2);
// Poses are single precision, relative to an origin near the robot.
const TOLERANCE = 1e-5;
let failed = 0;

async function test(name, body) {
  try {
    await body();
  } catch (error) {
    failed += 1;
    console.log(`FAILED ${name}\n${error.stack}`);
  }
}

const api = (page, expression) => page.evaluate(`window.softgauss.${expression}`);
const near = (a, b, tolerance = 1e-9) =>
  assert.ok(Math.abs(a - b) <= tolerance, `${a} is not ${b}`);
const settle = (page) =>
  page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
  );

/** Compares every link at some frames with forward kinematics of the log's rows. */
async function posesAreThoseOfTheLog(page, name) {
  const urdf = readUrdf(join(robots, `${name}.urdf`));
  const rows = new Map(readLog(join(folder, `${name}.csv`)).map((row) => [row.get('time_s'), row]));
  const frames = await api(page, 'header.frames.count');
  let compared = 0;
  for (const frame of [0, 7, Math.floor(frames / 3), frames - 2, frames - 1]) {
    await api(page, `frame(${frame})`);
    const row = rows.get(await api(page, 'time'));
    assert.ok(row, `frame ${frame} is at no time of the log`);
    for (const [link, matrix] of linkPoses(urdf, row)) {
      const { metres, turn } = difference(await api(page, `linkPose("${link}")`), matrix);
      assert.ok(
        metres < TOLERANCE && turn < TOLERANCE,
        `${name}, frame ${frame}, ${link}: ${metres} m, ${turn}`,
      );
      compared += 1;
    }
  }
  assert.ok(compared >= 5 * urdf.links.length);
}

const browser = await Browser.launch(folder, chromium);
const page = await browser.open('humanoid');
const atFirst = ['Joint positions', 'Controls', 'Contact normal forces', 'Goal errors'];

await test('every link is where forward kinematics of the log puts it', async () => {
  await posesAreThoseOfTheLog(page, 'humanoid');
  const arm = await browser.open('arm');
  await posesAreThoseOfTheLog(arm, 'arm');
  await arm.close();
});

const truth = new Truth(page, folder, robots, 'humanoid');
await test('the shapes that are drawn are those of the URDF, where its joints put them', async () => {
  for (const frame of [0, 25, 300]) await truth.shapes(frame);
  for (const link of ['torso', 'head']) await truth.pixel(link, truth.urdf.visuals.get(link)[0].rgba);
});

await test('the marks are at the centre of mass, the goal and its target', async () => {
  const goal = { link: 'right_hand', target: [0.45, -0.25, 1.1] };
  for (const frame of [0, 25, 600]) await truth.marks(frame, goal);
});

await test('the arrows carry the weight of who stands, the centre of pressure is amid them', () =>
  truth.standing(600, ['right_foot', 'left_foot']));

await test('curves, limits and legends are those of the log and the URDF', async () => {
  await truth.curves(77);
  await api(page, `setView({ groups: ${JSON.stringify(atFirst)} })`);
});

await test('the inspector gives pose and velocity', () => truth.inspector(25, 'right_hand'));

await test('an arm is drawn as its log has it', async () => {
  const arm = await browser.open('arm');
  const armTruth = new Truth(arm, folder, robots, 'arm');
  await armTruth.shapes(40);
  await armTruth.marks(120, { link: 'hand', target: [0.5, 0.3, 0.5] });
  await armTruth.curves(40);
  await armTruth.inspector(30, 'hand');
  await arm.close();
});

await test('between frames links move on, as rigid as they are', async () => {
  await api(page, 'frame(12)');
  const [a, t0] = [await api(page, 'linkPose("right_hand")'), await api(page, 'time')];
  await api(page, 'frame(13)');
  const [b, t1] = [await api(page, 'linkPose("right_hand")'), await api(page, 'time')];
  await api(page, `seek(${(t0 + t1) / 2})`);
  const c = await api(page, 'linkPose("right_hand")');
  const distance = (p, q) => Math.hypot(...p.position.map((x, i) => x - q.position[i]));
  assert.ok(distance(a, b) > 1e-4);
  near(distance(a, c), distance(a, b) / 2, 0.02 * distance(a, b));
  near(Math.hypot(...c.quaternion), 1);
});

await test('a click in the view selects the link that is there', async () => {
  await api(page, 'frame(300)');
  await settle(page);
  let clicked = 0;
  for (const link of ['head', 'torso', 'right_thigh', 'left_shin', 'right_foot']) {
    const [x, y] = await api(page, `screenPosition("${link}")`);
    await page.mouse.click(x, y);
    if ((await api(page, 'selected')) === link) clicked += 1;
  }
  // Some may be behind another from here.
  assert.ok(clicked >= 4, `${clicked} of 5`);
  await api(page, 'select("head")');
  assert.match(await page.locator('#inspector').innerText(), /head[\s\S]*abdomen_yaw/);
  const [x, y] = await api(page, 'screenPosition("torso")');
  await page.mouse.click(x, y);
  assert.equal(await api(page, 'selected'), 'torso');
  const time = await api(page, 'time');
  const row = readLog(join(folder, 'humanoid.csv')).find((r) => r.get('time_s') === time);
  const pose = linkPoses(readUrdf(join(robots, 'humanoid.urdf')), row).get('torso');
  const { metres, turn } = difference(await api(page, 'linkPose(window.softgauss.selected)'), pose);
  assert.ok(metres < TOLERANCE && turn < TOLERANCE);
  await page.keyboard.press('Escape');
  assert.equal(await api(page, 'selected'), null);
});

await test('the tree and its search select links', async () => {
  await page.keyboard.press('/');
  await page.keyboard.type('elbow');
  assert.equal(await page.locator('.tree li:visible:not(:has(ul li:visible))').count(), 2);
  await page.keyboard.press('Enter');
  assert.match(await api(page, 'selected'), /forearm$/);
  await page.keyboard.press('Escape');
  await page.locator('.tree .name').getByText('left_foot', { exact: true }).click();
  assert.equal(await api(page, 'selected'), 'left_foot');
  await page.locator('.tree li[tabindex="0"]').focus();
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('Enter');
  assert.equal(await api(page, 'selected'), 'left_ankle_stage');
  assert.ok((await page.locator('.legend .chosen').count()) > 0);
  await page.locator('#canvas').focus();
});

await test('space, arrows, home and end, brackets', async () => {
  await page.keyboard.press('Home');
  assert.equal(await api(page, 'time'), 0);
  await page.keyboard.press('ArrowRight');
  const second = await api(page, 'time');
  near(second, 1 / 60, 0.003);
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('ArrowLeft');
  assert.equal(await api(page, 'time'), second);
  await page.keyboard.press('End');
  assert.equal(await api(page, 'time'), await api(page, 'header.duration'));
  await page.keyboard.press('Home');
  await page.keyboard.press('Space');
  assert.equal(await api(page, 'playing'), true);
  await page.waitForFunction(() => window.softgauss.time > 0.3);
  await page.keyboard.press('Space');
  assert.equal(await api(page, 'playing'), false);
  await page.keyboard.press('[');
  assert.equal(await page.locator('#transport select').inputValue(), '0.5');
  await page.keyboard.press(']');
  assert.equal(await page.locator('#transport select').inputValue(), '1');
});

await test('it plays at the speed that it says, and loops', async () => {
  // Simulated over wall time; a slow machine may fall behind, none may run ahead.
  for (const speed of [0.125, 4]) {
    const rate = await page.evaluate(async (s) => {
      softgauss.setView({ speed: s });
      softgauss.seek(1);
      const start = performance.now();
      softgauss.play();
      while (softgauss.time < 1 + s / 2) await new Promise(requestAnimationFrame);
      const elapsed = (performance.now() - start) / 1000;
      softgauss.pause();
      return (softgauss.time - 1) / elapsed;
    }, speed);
    assert.ok(rate > 0.02 * speed && rate < 1.1 * speed, `${rate} at ${speed}`);
  }
  await page.evaluate(() => {
    softgauss.setView({ loop: true, speed: 8 });
    softgauss.seek(softgauss.header.duration - 0.1);
    softgauss.play();
  });
  await page.waitForFunction(() => softgauss.time < 5);
  assert.equal(await api(page, 'playing'), true);
  await page.evaluate(() => {
    softgauss.pause();
    softgauss.setView({ loop: false, speed: 1 });
  });
});

await test('the time line scrubs', async () => {
  const { x, y, width, height } = await page.locator('.timeline').boundingBox();
  await page.mouse.click(x + width / 2, y + height / 2);
  near(await api(page, 'time'), 5, 0.2);
});

await test('plots seek by click and drag, zoom by wheel, by shift and drag; all together', async () => {
  const group = 'Joint positions';
  const [left, y] = await plotPoint(page, group, 0.25);
  const [right] = await plotPoint(page, group, 0.75);
  await page.mouse.click(left, y);
  near(await api(page, 'time'), 2.5, 0.05);
  await page.mouse.down();
  await page.mouse.move(right, y, { steps: 4 });
  await page.mouse.up();
  near(await api(page, 'time'), 7.5, 0.05);
  await page.mouse.wheel(0, -400);
  await page.waitForFunction(() => softgauss.zoom[1] - softgauss.zoom[0] < 6);
  const [low, high] = await api(page, 'zoom');
  // What is under the pointer stays there.
  near(low + 0.75 * (high - low), 7.5, 0.05);
  await page.mouse.dblclick(left, y);
  assert.deepEqual(await api(page, 'zoom'), [0, await api(page, 'header.duration')]);
  await page.keyboard.down('Shift');
  await page.mouse.move(left, y);
  await page.mouse.down();
  await page.mouse.move(right, y, { steps: 4 });
  await page.mouse.up();
  await page.keyboard.up('Shift');
  const zoom = await api(page, 'zoom');
  near(zoom[0], 2.5, 0.05);
  near(zoom[1], 7.5, 0.05);
  // The time cursor is at the same place in all plots.
  await api(page, `seek(${(zoom[0] + zoom[1]) / 2})`);
  const places = await page
    .locator('.time-cursor')
    .evaluateAll((cursors) => cursors.map((cursor) => cursor.getBoundingClientRect().left));
  assert.ok(places.length >= 3);
  near(Math.max(...places), Math.min(...places), 1);
  near(places[0], (await plotPoint(page, group, 0.5))[0], 2);
  await page.keyboard.press('z');
  await page.keyboard.press('1');
  assert.equal(await page.locator(`section.plot[aria-label="${group}"]`).count(), 0);
  await page.keyboard.press('1');
  assert.equal(await page.locator(`section.plot[aria-label="${group}"]`).count(), 1);
});

await test('the theme follows the system until it is chosen; shapes and forces can be switched', async () => {
  const theme = () => page.evaluate(() => document.documentElement.dataset.theme);
  assert.equal(await theme(), 'light');
  await page.emulateMedia({ colorScheme: 'dark' });
  await page.waitForFunction(() => document.documentElement.dataset.theme === 'dark');
  await page.keyboard.press('t');
  assert.equal(await theme(), 'light');
  await api(page, 'seek(4)');
  const pictures = [];
  for (const key of ['', 'c', 'c', 'c', 'g']) {
    if (key) await page.keyboard.press(key);
    await settle(page);
    pictures.push((await page.locator('#canvas').screenshot()).toString('base64'));
  }
  const [visual, collision, both, again, noForces] = pictures;
  assert.equal(new Set([visual, collision, both, noForces]).size, 4);
  assert.equal(visual, again);
  await page.keyboard.press('g');
});

await test('the camera follows', async () => {
  await page.evaluate(() => {
    softgauss.seek(0);
    softgauss.select('right_hand');
  });
  await page.locator('#canvas').focus();
  await page.keyboard.press('f');
  await settle(page);
  const before = await api(page, 'screenPosition("right_hand")');
  await api(page, 'seek(2)');
  await settle(page);
  const after = await api(page, 'screenPosition("right_hand")');
  // The hand turns about its origin, which is what is followed.
  assert.ok(Math.hypot(after[0] - before[0], after[1] - before[1]) < 25, `${before} ${after}`);
  await page.keyboard.press('f');
  await page.evaluate(() => {
    softgauss.select(null);
    softgauss.setView({ preset: 'home' });
  });
});

await test('help opens and closes', async () => {
  await page.keyboard.press('?');
  assert.ok(await page.locator('#help').isVisible());
  await page.keyboard.press('Escape');
  assert.ok(!(await page.locator('#help').isVisible()));
});

await test('every button has a name, and none is outside the window or over another', async () => {
  const sizes = [[1280, 800], [1920, 1080], [800, 600], [390, 800]];
  for (const [width, height] of sizes) {
    await page.setViewportSize({ width, height });
    await settle(page);
    const found = await page.evaluate(misplacedButtons);
    assert.deepEqual(found, [], `${width} × ${height}`);
    await browser.screenshot(page, `humanoid_${width}x${height}`);
  }
});
await page.close();

await test('a dark window opens dark; what plays by itself stops at the end', async () => {
  const hand = await browser.open('hand', { scheme: 'dark', motion: 'no-preference' });
  assert.equal(await hand.evaluate(() => document.documentElement.dataset.theme), 'dark');
  await hand.waitForFunction(
    () => softgauss.time === softgauss.header.duration && !softgauss.playing,
  );
  await browser.screenshot(hand, 'hand_dark');
  await hand.close();
});

await test('a run that failed says why', async () => {
  const bad = await browser.open('failed');
  const said = await bad.getByRole('alert').innerText();
  assert.match(said, /^The simulation became non-finite at t = 0\.1 s/);
  assert.ok((await api(bad, 'header.duration')) < 0.11);
  await browser.screenshot(bad, 'failed');
  await bad.close();
});

await test('of a thinned run legends give the range of the bucket', async () => {
  const long = await browser.open('long');
  const bucket = await api(long, 'header.series.bucket');
  assert.ok(bucket > 1, `bucket of ${bucket}`);
  const longTruth = new Truth(long, folder, robots, 'long', 'arm');
  for (const time of [0.10005, 0.6, 1.0]) await longTruth.ranges(time, bucket);
  await long.close();
});

await test('what a run says is text, not markup', async () => {
  browser.alter('arm', 'altered', (header) => {
    header.outcome = { kind: 'non-finite', message: 'the state became <b>bad</b> at <elbow>' };
  });
  const bad = await browser.open('altered');
  const banner = bad.getByRole('alert');
  assert.equal(await banner.innerText(), 'The state became <b>bad</b> at <elbow>.');
  await bad.close();
});

await test('the page may ask nothing of any network', async () => {
  const closed = await browser.open('arm');
  const before = browser.complaints.length;
  const answer = await closed.evaluate(() =>
    fetch('https://example.org').then(
      () => 'sent',
      () => 'refused',
    ),
  );
  assert.equal(answer, 'refused');
  const said = browser.complaints.splice(before);
  assert.ok(said.some((text) => text.includes('Content Security Policy')));
  assert.ok(!said.some((text) => text.includes('asked')));
  await closed.close();
});

// Last, when other pages are closed and other tests likely done: a busy machine says little.
await page.close();
await test('a page of the humanoid is small and soon there', async () => {
  const size = statSync(join(folder, 'humanoid.html')).size;
  const firstFrame = await browser.leastTimeToFirstFrame('humanoid', 10);
  console.log(`humanoid, 10 s: ${size} bytes, first frame after ${firstFrame.toFixed(0)} ms`);
  assert.ok(size < 15e6, `${size} bytes`);
  assert.ok(firstFrame < 2000, `${firstFrame} ms`);
});

await browser.close();

await test('without WebGL the page says so and shows the plots', async () => {
  const blind = await Browser.launch(folder, chromium, ['--disable-3d-apis']);
  const plain = await blind.open('arm');
  assert.match(await plain.locator('#no-view').innerText(), /no WebGL/);
  await posesAreThoseOfTheLog(plain, 'arm');
  const [x, y] = await plotPoint(plain, 'Controls', 0.5);
  await plain.mouse.click(x, y);
  near(await api(plain, 'time'), 1, 0.02);
  await blind.screenshot(plain, 'without_webgl');
  browser.complaints.push(...blind.complaints);
  await blind.close();
});

await test('no page complained, none asked for anything', () =>
  assert.deepEqual(browser.complaints, []));
process.exit(failed ? 1 : 0);
