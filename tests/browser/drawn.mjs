// SPDX-License-Identifier: Apache-2.0
// What the page draws against the log and the URDF: `window.softgauss.drawn()` reads the scene graph
// and the plots back, the oracle of kinematics.mjs says what they must hold.

import assert from 'node:assert/strict';
import { join } from 'node:path';
import {
  centerOfMass,
  linkPoses,
  position,
  product,
  readLog,
  readUrdf,
  velocity,
} from './kinematics.mjs';

// Poses are single precision, relative to an origin near the robot.
const TOLERANCE = 1e-5;
const GRAVITY = 9.81;

const distance = (a, b) => Math.hypot(...a.map((x, i) => x - b[i]));
const numbersIn = (text) =>
  (text.match(/[−-]?\d+(\.\d+)?(e[−-]?\d+)?/g) ?? []).map((x) => Number(x.replaceAll('−', '-')));

function close(a, b, tolerance, what) {
  assert.equal(a.length, b.length, what);
  assert.ok(distance(a, b) <= tolerance, `${what}: [${a}] is not [${b}]`);
}

/** A page beside the truth of its run. */
export class Truth {
  constructor(page, folder, robots, name, robot = name) {
    this.page = page;
    this.urdf = readUrdf(join(robots, `${robot}.urdf`));
    this.rows = readLog(join(folder, `${name}.csv`));
    this.index = new Map(this.rows.map((row, i) => [row.get('time_s'), i]));
  }

  /** Goes to a frame; gives what is drawn there, the log's row and the links' poses. */
  async at(frame, { withPlots = false } = {}) {
    const [drawn, time] = await this.page.evaluate(
      async ([i, isWhole]) => {
        softgauss.frame(i);
        // Marks are placed with the next picture.
        for (let k = 0; k < 2; ++k) await new Promise(requestAnimationFrame);
        const { plots, ...view } = softgauss.drawn();
        return [isWhole ? { ...view, plots } : view, softgauss.time];
      },
      [frame, withPlots],
    );
    const index = this.index.get(time);
    assert.ok(index !== undefined, `frame ${frame} is at no time of the log`);
    const poses = linkPoses(this.urdf, this.rows[index]);
    return { drawn, time, index, row: this.rows[index], poses };
  }

  /** Every visual shape of every link: where it is, how it is turned, how large, which colour. */
  async shapes(frame) {
    const { drawn, poses } = await this.at(frame);
    for (const [link, visuals] of this.urdf.visuals) {
      const found = drawn.shapes.filter((shape) => shape.link === link);
      assert.equal(found.length, visuals.length, `shapes of ${link}`);
      visuals.forEach(({ origin, halfExtents, rgba }, i) => {
        const pose = product(poses.get(link), origin);
        close(found[i].middle, position(pose), TOLERANCE, `${link}, shape ${i}`);
        halfExtents.forEach((half, k) => {
          const axis = [0, 1, 2].map((r) => half * pose[r][k]);
          close(found[i].halfAxes[k], axis, TOLERANCE, `${link}, shape ${i}, axis ${k}`);
        });
        const { r, g, b } = found[i].color;
        // Dark surfaces are drawn a little lighter.
        if (rgba) close([r, g, b], rgba.slice(0, 3), 0.12, `colour of ${link}, shape ${i}`);
      });
    }
  }

  /** Centre of mass, the goal's point (a link's origin) and its target. */
  async marks(frame, { link, target }) {
    const { drawn, poses, row } = await this.at(frame);
    close(drawn.com, centerOfMass(this.urdf, poses, row), TOLERANCE, 'centre of mass');
    const [goal] = drawn.goals;
    close(goal.point, position(poses.get(link)), TOLERANCE, "the goal's point");
    if (target) close(goal.target, target, TOLERANCE, "the goal's target");
  }

  /** A robot that stands still on level ground at z = 0: its feet carry its weight. */
  async standing(frame, feet) {
    const { drawn, poses } = await this.at(frame);
    const { arrows, metresPerNewton, com, cop } = drawn;
    assert.ok(arrows.length >= 3, `${arrows.length} arrows`);
    const shown = await this.page.locator('.force-scale output').innerText();
    const newtons = numbersIn(shown)[0] / 0.1;
    assert.ok(Math.abs(newtons * metresPerNewton - 1) < 0.06, `${shown}: ${metresPerNewton} m/N`);
    const boxes = feet.flatMap((foot) =>
      this.urdf.visuals.get(foot).map(({ origin, halfExtents }) => {
        const pose = product(poses.get(foot), origin);
        const reach = [0, 1].map((r) =>
          halfExtents.reduce((sum, half, k) => sum + half * Math.abs(pose[r][k]), 0),
        );
        return { middle: position(pose), reach };
      }),
    );
    const under = ([x, y]) =>
      boxes.some(
        ({ middle, reach }) =>
          Math.abs(x - middle[0]) <= reach[0] && Math.abs(y - middle[1]) <= reach[1],
      );
    let weight = 0;
    const pressed = [0, 0];
    for (const { base, vector } of arrows) {
      assert.ok(vector[2] > 0, `an arrow points down: ${vector}`);
      assert.ok(Math.abs(base[2]) < 0.005 && under(base), `an arrow begins at ${base}`);
      weight += vector[2] / metresPerNewton;
      pressed[0] += base[0] * vector[2];
      pressed[1] += base[1] * vector[2];
    }
    const expected = this.urdf.mass * GRAVITY;
    assert.ok(Math.abs(weight / expected - 1) < 0.01, `${weight} N, weight ${expected} N`);
    const sum = weight * metresPerNewton;
    close(cop, [...pressed.map((x) => x / sum), 0], 1e-3, 'centre of pressure');
    // Between the feet, not under a foot: so within the box around both.
    const inside = [0, 1].every(
      (k) =>
        cop[k] >= Math.min(...boxes.map((b) => b.middle[k] - b.reach[k])) &&
        cop[k] <= Math.max(...boxes.map((b) => b.middle[k] + b.reach[k])),
    );
    assert.ok(inside, `centre of pressure ${cop}`);
    assert.ok(
      distance(cop.slice(0, 2), com.slice(0, 2)) < 0.05 && com[2] > cop[2],
      `centre of pressure ${cop}, centre of mass ${com}`,
    );
  }

  /** The legend of a plot: names and what stands beside them. */
  #legend(group) {
    const parts = ['.name', '.value'];
    return this.page
      .locator(`section.plot[aria-label="${group}"] .legend li`)
      .evaluateAll(
        (items, classes) =>
          items.map((item) => classes.map((name) => item.querySelector(name).textContent)),
        parts,
      );
  }

  /** Curves, limits and legends of joints. */
  async curves(frame) {
    const groups = [
      ['Joint positions', 'q', ({ lower, upper }) => [lower, upper]],
      ['Controls', 'u', ({ effort }) => [-effort, effort]],
      ['Joint velocities', 'v', null],
    ];
    await this.page.evaluate(
      (names) => softgauss.setView({ groups: names, limits: true }),
      groups.map(([name]) => name),
    );
    const { drawn, row } = await this.at(frame, { withPlots: true });
    for (const [name, letter, limits] of groups) {
      const plot = drawn.plots.find(({ group }) => group === name);
      assert.ok(plot, name);
      assert.equal(plot.times.length, this.rows.length, name);
      assert.ok(plot.curves.length >= 7);
      const entries = [0, 0.13, 0.5, 0.77, 1].map((s) => Math.round(s * (plot.times.length - 1)));
      const texts = await this.#legend(name);
      assert.equal(texts.length, plot.curves.length);
      plot.curves.forEach(({ name: joint, values }, c) => {
        const column = `${letter}:${joint}`;
        for (const entry of entries) {
          const logged = this.rows[entry].get(column);
          const error = Math.abs(values[entry] - logged);
          const bound = 1e-6 * Math.abs(logged) + 1e-12;
          assert.ok(error <= bound, `${column}: ${values[entry]}, ${logged}`);
          assert.equal(plot.times[entry], this.rows[entry].get('time_s'));
        }
        const logged = row.get(column);
        assert.equal(texts[c][0], joint);
        const [said] = numbersIn(texts[c][1]);
        // Three digits, two of what is below a thousandth.
        const bound = Math.abs(logged) * (Math.abs(logged) < 1e-3 ? 0.06 : 0.006);
        assert.ok(
          Math.abs(said - logged) <= bound,
          `legend of ${column}: ${texts[c][1]}, ${logged}`,
        );
        if (!limits) return;
        const urdf = this.urdf.joints.find((other) => other.name === joint);
        const lines = plot.limits.filter((line) => line.curve === joint).map(({ value }) => value);
        const expected = urdf.type === 'continuous' && letter === 'q' ? [] : limits(urdf);
        close(lines, expected, 1e-6 * Math.hypot(1, ...expected), `limits of ${column}`);
      });
    }
    await this.page.evaluate(() => softgauss.setView({ limits: false }));
    await this.#nearLimits(frame, groups);
  }

  /** Unless others are asked for, limits are marked that are near what the curves come to. */
  async #nearLimits(frame, groups) {
    const { drawn } = await this.at(frame, { withPlots: true });
    for (const [name, letter, limits] of groups) {
      if (!limits) continue;
      const plot = drawn.plots.find(({ group }) => group === name);
      for (const { name: joint } of plot.curves) {
        const urdf = this.urdf.joints.find((other) => other.name === joint);
        if (urdf.type === 'continuous' && letter === 'q') continue;
        const values = this.rows.slice(0, -1).map((row) => row.get(`${letter}:${joint}`));
        const [least, greatest] = [Math.min(...values), Math.max(...values)];
        const [lower, upper] = limits(urdf);
        const near = Math.max(greatest - least, 0.02 * (upper - lower));
        const lines = plot.limits.filter((line) => line.curve === joint).map(({ value }) => value);
        for (const [limit, gap] of [
          [lower, least - lower],
          [upper, upper - greatest],
        ]) {
          const isMarked = lines.some((value) => Math.abs(value - limit) < 1e-6 * (1 + near));
          if (Math.abs(gap - near) > 1e-3 * near)
            assert.equal(isMarked, gap < near, `limit ${limit} of ${letter}:${joint}`);
        }
      }
    }
  }

  /** A thinned run: legends give the least and the greatest value of the bucket at a time. */
  async ranges(time, bucket) {
    const group = 'Joint velocities';
    await this.page.evaluate(
      ([name, t]) => {
        softgauss.setView({ groups: [name] });
        softgauss.seek(t);
      },
      [group, time],
    );
    const texts = await this.#legend(group);
    const index = this.rows.findIndex((row) => row.get('time_s') > time + 1e-12) - 1;
    const first = index - (index % bucket);
    let wide = 0;
    for (const [joint, text] of texts) {
      const values = this.rows.slice(first, first + bucket).map((row) => row.get(`v:${joint}`));
      const expected = [Math.min(...values), Math.max(...values)];
      const said = numbersIn(text);
      if (said.length === 2) wide += 1;
      assert.match(text, /^[^…]+ … [^…]+$|^[^…]+$/);
      [said[0], said.at(-1)].forEach((x, k) => {
        const error = Math.abs(x - expected[k]);
        assert.ok(error <= 0.06 * Math.abs(expected[k]), `${joint}: ${text}, ${expected}`);
      });
    }
    assert.ok(wide >= 3, `${wide} ranges`);
  }

  /** The numbers of a link, with velocities from the log's rows before and after. */
  async inspector(frame, link) {
    await this.page.evaluate((name) => softgauss.select(name), link);
    const { index, poses } = await this.at(frame);
    const said = new Map(
      await this.page
        .locator('#inspector dl')
        .evaluate((list) =>
          [...list.querySelectorAll('dt')].map((dt) => [
            dt.textContent,
            dt.nextElementSibling.textContent,
          ]),
        ),
    );
    const numbers = (name) => numbersIn(said.get(name));
    close(numbers('Position [m]'), position(poses.get(link)), 1e-4, `${link}, position`);
    const [before, after] = [index - 1, index + 1].map((i) => this.rows[i]);
    const { linear, angular } = velocity(
      linkPoses(this.urdf, before).get(link),
      linkPoses(this.urdf, after).get(link),
      after.get('time_s') - before.get('time_s'),
    );
    const moves = Math.min(Math.hypot(...linear), Math.hypot(...angular));
    assert.ok(moves > 0.05, `${link} is too slow to tell: ${linear}, ${angular}`);
    for (const [vector, length, expected] of [
      ['Velocity [m/s]', 'Speed [m/s]', linear],
      ['Angular vel. [rad/s]', 'Angular speed [rad/s]', angular],
    ]) {
      const size = Math.hypot(...expected);
      close(numbers(vector), expected, 0.002 + 0.02 * size, `${link}, ${vector}`);
      close(numbers(length), [size], 0.002 + 0.02 * size, `${link}, ${length}`);
    }
    await this.page.evaluate(() => softgauss.select(null));
  }

  /** In the middle of a link the picture has its colour: the same hue, and not much greyer. */
  async pixel(link, rgba) {
    const marks = ['forces', 'contacts', 'com', 'cop', 'goals'];
    const set = (shown) =>
      this.page.evaluate(
        (view) => softgauss.setView(view),
        Object.fromEntries(marks.map((mark) => [mark, shown])),
      );
    await set(false);
    await this.at(0);
    const [x, y] = await this.page.evaluate((name) => softgauss.screenPosition(name), link);
    const png = await this.page.screenshot({ clip: { x: x - 1, y: y - 1, width: 3, height: 3 } });
    const seen = await this.page.evaluate(async (data) => {
      const image = new Image();
      image.src = `data:image/png;base64,${data}`;
      await image.decode();
      const canvas = Object.assign(document.createElement('canvas'), { width: 3, height: 3 });
      const context = canvas.getContext('2d');
      context.drawImage(image, 0, 0);
      return [...context.getImageData(1, 1, 1, 1).data].slice(0, 3).map((c) => c / 255);
    }, png.toString('base64'));
    await set(true);
    const [is, should] = [hsv(seen), hsv(rgba)];
    const turn = Math.abs(((is.hue - should.hue + 540) % 360) - 180);
    assert.ok(
      turn < 25 && is.saturation > 0.4 * should.saturation && is.value > 0.3 * should.value,
      `${link} is drawn [${seen}], its colour is [${rgba}]`,
    );
  }
}

function hsv([r, g, b]) {
  const value = Math.max(r, g, b);
  const span = value - Math.min(r, g, b);
  const sixth =
    value === r ? (g - b) / span : value === g ? 2 + (b - r) / span : 4 + (r - g) / span;
  return { hue: span > 0 ? (60 * sixth + 360) % 360 : 0, saturation: span / value || 0, value };
}
