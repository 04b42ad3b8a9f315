// SPDX-License-Identifier: Apache-2.0
// States of an SRDF, keyframes, sliders, the camera and the way to the start, in a live page.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { copyFileSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { LiveProcess } from './live_process.mjs';

const CROUCH = `<robot name="humanoid">
  <group_state name="crouch" group="legs">
    ${['left', 'right']
      .map(
        (side) => `<joint name="${side}_hip_pitch" value="0.7"/>
    <joint name="${side}_knee" value="1.4"/>
    <joint name="${side}_ankle_pitch" value="0.7"/>`,
      )
      .join('\n    ')}
  </group_state>
  <group_state name="upright" group="legs">
    <joint name="left_knee" value="0"/>
  </group_state>
</robot>
`;

/** States of an SRDF, keyframes, sliders of a run that goes on, the camera, the way to the start. */
export async function testStates({ browser, simulator, folder, data, status, until, stepsMore, distance }) {
  mkdirSync(join(folder, 'crouch'), { recursive: true });
  const urdf = join(folder, 'crouch/humanoid.urdf');
  copyFileSync(join(data, 'robots/humanoid.urdf'), urdf);
  writeFileSync(join(folder, 'crouch/humanoid.srdf'), CROUCH);
  const run = await LiveProcess.start(simulator, folder, 'live_states', [urdf, '--timestep', '0.004']);
  const pelvis = (page) => page.evaluate(() => window.softgauss.linkPose('pelvis').position[2]);
  const lower = (height) => window.softgauss.linkPose('pelvis').position[2] < height;
  const higher = (height) => window.softgauss.linkPose('pelvis').position[2] > height;

  const first = await browser.visit(run.address);
  await until(first, () => window.softgauss.live.status.time > 1);
  await first.close();
  // Home of a page that was opened late; and its button.
  const page = await browser.visit(run.address);
  for (const goHome of [
    () => page.keyboard.press('Home'),
    () => page.getByRole('button', { name: 'To the start' }).click(),
  ]) {
    await until(page, () => window.softgauss.time > 1);
    await page.locator('#canvas').focus();
    await goHome();
    await until(page, () => window.softgauss.time < 0.9);
  }

  // A state of the SRDF is a button; what holds the posture holds the state.
  const upright = await pelvis(page);
  const states = page.getByRole('group', { name: 'States of the SRDF' });
  assert.deepEqual(await states.getByRole('button').allInnerTexts(), ['crouch', 'upright']);
  await states.getByRole('button', { name: 'crouch' }).click();
  await until(page, lower, upright - 0.05);
  await stepsMore(page, 500); // two seconds
  const crouched = await pelvis(page);
  assert.ok(crouched < upright - 0.05, `${crouched} of ${upright} m`);
  assert.deepEqual((await status(page)).fallen, []);

  // Stored with shift, and gone to; a number that holds nothing does nothing.
  const slot = (i) => page.getByRole('button', { name: `Keyframe ${i}` });
  await page.locator('#canvas').focus();
  await page.keyboard.press('Shift+Digit1');
  await until(page, () => window.softgauss.live.status.stored.includes(1));
  assert.equal(await slot(1).getAttribute('aria-pressed'), 'true');
  assert.equal(await slot(2).isDisabled(), true);
  await states.getByRole('button', { name: 'upright' }).click();
  await until(page, higher, upright - 0.03);
  await stepsMore(page, 100);
  await page.keyboard.press('2');
  await page.keyboard.press('1');
  await until(page, lower, upright - 0.05);
  await browser.screenshot(page, 'live_states');
  await page.getByLabel('Store').check();
  await slot(2).click();
  await until(page, () => window.softgauss.live.status.stored.includes(2));
  await page.getByLabel('Store').uncheck();
  await states.getByRole('button', { name: 'upright' }).click();
  await until(page, higher, upright - 0.03);
  await slot(2).click();
  await until(page, lower, upright - 0.05);

  // The camera goes with a link: it stays where it is in the view, and comes lower with the pelvis.
  const place = (name) => page.evaluate((link) => window.softgauss.screenPosition(link), name);
  await page.evaluate(() => window.softgauss.select('pelvis'));
  await page.locator('#canvas').focus();
  await page.keyboard.press('f');
  const before = await place('pelvis');
  await states.getByRole('button', { name: 'upright' }).click();
  await until(page, higher, upright - 0.03);
  await stepsMore(page, 50);
  const after = await place('pelvis');
  assert.ok(distance(before, after) < 3, `the pelvis moved by ${distance(before, after)} pixels`);
  await page.keyboard.press('f');

  // Sliders of a run that goes on are what its posture seeks.
  await page.getByText('Joints', { exact: true }).click();
  await page.getByLabel('left_elbow in rad').fill('1.2');
  const elbow = await page.evaluate(() =>
    window.softgauss.header.live.joints.findIndex(({ name }) => name === 'left_elbow'),
  );
  await until(page, (i) => Math.abs(window.softgauss.live.status.joints[i] - 1.2) < 0.02, elbow);
  assert.equal((await status(page)).paused, false);
  assert.equal((await status(page)).targets[elbow], 1.2);
  await browser.screenshot(page, 'live_sliders');

  // Arrows are as long as those of the page that replays what was seen.
  await stepsMore(page, 1000);
  const scale = await page.evaluate(() => window.softgauss.drawn().metresPerNewton);
  const [file] = await Promise.all([
    page.waitForEvent('download'),
    page.getByRole('button', { name: 'Save replay page' }).click(),
  ]);
  await file.saveAs(join(folder, 'live_states.html'));
  await page.close();
  assert.equal(await run.stop(), 130);
  const replay = await browser.open('live_states');
  const replayed = await replay.evaluate(() => window.softgauss.drawn().metresPerNewton);
  await replay.close();
  assert.ok(Math.abs(scale / replayed - 1) < 0.3, `${scale} of ${replayed} m/N`);

  for (const kind of ['state', 'store', 'recall', 'reset', 'joint'])
    assert.match(run.events(), new RegExp(`, ${kind}: \\{`), `${kind} is recorded`);
  const again = join(folder, 'live_states_again.json');
  const played = spawnSync(simulator, [...run.arguments, '--play', run.file('record'), '--summary', again, '--quiet']);
  assert.equal(played.status, 0, played.stderr.toString());
  assert.equal(JSON.parse(readFileSync(again, 'utf8')).state_hash, run.summary().state_hash);
}
