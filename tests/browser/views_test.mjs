// SPDX-License-Identifier: Apache-2.0
// Replay pages of special runs in Chromium.
//
//   node views_test.mjs FOLDER CHROMIUM SIMULATE_GDD DATA

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { QUARTERS, writeSquares } from './image_inputs.mjs';
import { Browser } from './pages.mjs';

const [folder, chromium, simulator, data] = process.argv.slice(2);
const browser = await Browser.launch(folder, chromium);
const SMALL = { width: 900, height: 620 };

/** Records a run as NAME.html. */
function record(name, ...args) {
  const view = join(folder, `${name}.html`);
  const run = spawnSync(simulator, [...args, '--view', view, '--quiet']);
  assert.equal(run.status, 0, run.stderr.toString());
  return view;
}

const api = (page, expression) => page.evaluate(`window.softgauss.${expression}`);
const settle = (page) =>
  page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
  );
const distance = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));

/** What a button gives, as bytes. */
async function downloaded(page, click) {
  const [file] = await Promise.all([page.waitForEvent('download'), click()]);
  return readFileSync(await file.path());
}

async function testBeside() {
  const arm = join(data, 'robots/arm.urdf');
  const first = record('beside_first', arm, '--reach', 'hand=0.5,0.3,0.5', '--duration', '1');
  record('beside_second', arm, '--reach', 'hand=0.4,-0.3,0.6', '--duration', '1', '--view-with', first);
  const alone = await browser.open('beside_first', SMALL);
  await api(alone, 'seek(0.5)');
  const expected = (await api(alone, 'drawn()')).shapes;
  assert.equal((await api(alone, 'drawn()')).beside, null);

  // Held by the page.
  const page = await browser.open('beside_second', SMALL);
  await page.waitForFunction(() => window.softgauss.drawn().beside);
  await api(page, 'seek(0.5)');
  const { shapes, beside } = await api(page, 'drawn()');
  assert.equal(beside.length, expected.length);
  beside.forEach((shape, i) => assert.ok(distance(shape.middle, expected[i].middle) < 1e-6));
  assert.ok(Math.max(...shapes.map((shape, i) => distance(shape.middle, beside[i].middle))) > 0.1);
  // Clicks select links of this run alone, and it is this run's that is drawn solid.
  assert.match(await page.locator('#beside').innerText(), /Translucent: arm/);
  await settle(page);
  await browser.screenshot(page, 'beside');
  await page.getByRole('button', { name: 'Take it away' }).click();
  assert.equal((await api(page, 'drawn()')).beside, null);

  // Dropped on the page.
  const drop = (text, name) =>
    page.evaluate(
      ([content, file]) => {
        const dataTransfer = new DataTransfer();
        dataTransfer.items.add(new File([content], file, { type: 'text/html' }));
        for (const type of ['dragover', 'drop'])
          document.body.dispatchEvent(
            new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }),
          );
      },
      [text, name],
    );
  await drop('<p>no run</p>', 'letter.html');
  await page.getByText('letter.html is no replay page of softgauss.').waitFor();
  await drop(readFileSync(first, 'utf8'), 'other.html');
  await page.waitForFunction(() => window.softgauss.drawn().beside);
  const dropped = (await api(page, 'drawn()')).beside;
  dropped.forEach((shape, i) => assert.ok(distance(shape.middle, expected[i].middle) < 1e-6));
  await page.close();

  // Chosen by the button; grids only where there is ground.
  await alone.locator('#choose-beside').setInputFiles(join(folder, 'beside_second.html'));
  await alone.waitForFunction(() => window.softgauss.drawn().beside);
  assert.equal((await api(alone, 'drawn()')).grids, 0);
  await alone.close();
}

async function testImages() {
  writeSquares(folder);
  for (const kind of ['obj', 'dae']) {
    const model = join(folder, `square_${kind}.urdf`);
    record(`square_${kind}`, model, '--passive', '--base', 'fixed', '--duration', '0.1');
    const page = await browser.open(`square_${kind}`, SMALL);
    await page.evaluate(() => {
      softgauss.setView({ preset: 'front', com: false, links: false, plots: false });
    });
    await settle(page);
    await settle(page);
    const [x, y] = await api(page, 'screenPosition("square")');
    for (const [place, rgb] of Object.entries(QUARTERS)) {
      const [dx, dy] = [place.endsWith('left') ? -40 : 40, place.startsWith('top') ? -40 : 40];
      const seen = await pixel(page, x + dx, y + dy);
      // Light changes how bright it is, not which colour it is.
      const size = (v) => Math.hypot(...v);
      const cosine = seen.reduce((sum, s, k) => sum + s * rgb[k], 0) / (size(seen) * size(rgb));
      assert.ok(cosine > 0.97, `${kind}, ${place}: [${seen}], expected [${rgb}]`);
    }
    await browser.screenshot(page, `image_${kind}`);
    await page.close();
  }
}

async function pixel(page, x, y) {
  const shot = await page.screenshot({ clip: { x: x - 1, y: y - 1, width: 3, height: 3 } });
  return page.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const canvas = Object.assign(document.createElement('canvas'), { width: 3, height: 3 });
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    return [...context.getImageData(1, 1, 1, 1).data].slice(0, 3);
  }, shot.toString('base64'));
}

async function testPicks() {
  record('picks', join(data, 'scenes/arm_picks.yaml'), '--duration', '3');
  const page = await browser.open('picks');
  // Goals are drawn while they act.
  for (const [time, acting] of [[0.5, 0], [1.5, 1], [2.8, 2]]) {
    await api(page, `seek(${time})`);
    await settle(page);
    const goals = (await api(page, 'drawn()')).goals.map(({ target }) => target !== null);
    assert.deepEqual(goals, goals.map((_, i) => i === acting), `${time} s`);
  }
  assert.equal((await api(page, 'drawn()')).grids, 1);

  // The table of contacts follows the time; a click marks one.
  await page.getByText('Contacts', { exact: true }).click();
  const rows = page.locator('#contact-table tbody tr:visible');
  const grip = rows.filter({ hasText: 'finger' });
  await grip.nth(1).waitFor();  // the table is made with the next picture; two fingers hold the cube
  const cells = await grip.first().locator('td').allInnerTexts();
  assert.ok(Number(cells[2]) > 1 && Number(cells[4]) < 0.01, `${cells}`);
  await grip.first().click();
  assert.equal(await grip.first().getAttribute('aria-selected'), 'true');
  await browser.screenshot(page, 'picks');
  // It is the pair that is marked, not the row: other contacts take its place when it is gone.
  const selected = page.locator('#contact-table tbody tr[aria-selected="true"]:visible');
  await api(page, 'seek(0.2)');
  assert.equal(await grip.count(), 0, 'the fingers are open');
  assert.equal(await selected.count(), 0, 'what touches now is another pair');

  // Curves as a table: a row a sample.
  const table = (
    await downloaded(page, () => page.getByRole('button', { name: /as a table/ }).click())
  ).toString();
  const lines = table.trimEnd().split('\n');
  assert.match(lines[0], /^time_s,Joint positions: shoulder_yaw \[rad\],/);
  const columns = (lines[0].match(/\[|iterations|rows|contacts|updates/g) ?? []).length;
  assert.ok(columns > 20, `${columns} columns`);
  assert.equal(lines.length, 1 + Math.round(3 / (await api(page, 'header.timestep'))) + 1);

  // The camera is in the address: who opens it looks from there.
  const { x, y } = await page.locator('#canvas').boundingBox();
  await page.mouse.move(x + 30, y + 300);
  await page.mouse.down();
  await page.mouse.move(x + 160, y + 330, { steps: 4 });
  await page.mouse.up();
  await page.waitForFunction(() => window.location.hash.startsWith('#camera='));
  // It comes to rest.
  let place = null;
  for (let i = 0; i < 100; ++i) {
    const now = await api(page, 'screenPosition("cube")');
    if (place && distance(place, now) < 1e-3) break;
    place = now;
    await settle(page);
  }
  const address = await page.evaluate(() => window.location.href);
  await page.goto('about:blank');
  await page.goto(address);
  await page.waitForFunction(() => window.softgauss);
  await page.evaluate(() => window.softgauss.ready);
  await api(page, 'seek(0.2)');
  await settle(page);
  const again = await api(page, 'screenPosition("cube")');
  assert.ok(distance(place, again) < 25, `${place} is not ${again}`);

  // A video of the view.
  await page.getByRole('button', { name: 'Begin a video' }).click();
  await page.evaluate(() => softgauss.play());
  await page.waitForTimeout(1500);
  const video = await downloaded(page, () =>
    page.getByRole('button', { name: 'End the video' }).click(),
  );
  assert.equal(video.readUInt32BE(0), 0x1a45dfa3, 'WebM');
  assert.ok(video.length > 3000, `${video.length} bytes`);
  await page.close();
}

async function testLongNames() {
  const long = (name) => `${name}_${'very_long_'.repeat(12)}name`;
  browser.alter('picks', 'long_names', (header) => {
    header.model = long('model');
    for (const body of header.bodies) [body.name, body.joint] = [long(body.name), long(body.joint)];
    for (const link of header.links) link.name = long(link.name);
    for (const list of [header.geometries, header.visuals])
      for (const shape of list) shape.link = shape.link && long(shape.link);
    for (const group of header.series.groups)
      for (const curve of group.curves) curve.name = long(curve.name);
  });
  for (const [width, height] of [
    [390, 800],
    [1280, 800],
  ]) {
    const page = await browser.open('long_names', { width, height });
    await page.evaluate((name) => {
      softgauss.setView({ links: true });
      softgauss.select(name);
      softgauss.seek(2.5);
      document.querySelector('.contacts').open = true;
    }, long('tool'));
    await settle(page);
    await browser.screenshot(page, `long_names_${width}`);
    const wide = await page.evaluate(() =>
      [document.documentElement, ...document.querySelectorAll('#top, #tree, #inspector, #plots')]
        .filter((node) => node.scrollWidth > node.clientWidth + 1)
        .map((node) => node.id || node.tagName),
    );
    assert.deepEqual(wide, [], `too wide at ${width}`);
    // A name that is cut is told whole by its tooltip.
    assert.equal(await page.locator('#tree .name').first().getAttribute('title'), long('world'));
    await page.close();
  }
}

for (const test of [testBeside, testImages, testPicks, testLongNames]) {
  await test();
}
await browser.close();
assert.deepEqual(browser.complaints, []);
console.log('runs beside runs, images, goals that come and go, and long names are shown');
