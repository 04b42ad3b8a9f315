// SPDX-License-Identifier: Apache-2.0
// The last minute of a figure as a small curve: the least value at the bottom, the greatest on top.

import { element, number } from '../app/dom.js';

const SAMPLES = 300; // five a second
const [WIDTH, HEIGHT] = [96, 18]; // pixels

export class Sparkline {
  constructor() {
    this.values = [];
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    this.canvas = element('canvas', {
      class: 'sparkline',
      width: WIDTH * ratio,
      height: HEIGHT * ratio,
      'aria-hidden': 'true',
    });
    this.ratio = ratio;
  }

  /** NaN or null is a gap. */
  add(value, unit = '') {
    this.values.push(value ?? NaN);
    if (this.values.length > SAMPLES) this.values.shift();
    if (this.canvas.checkVisibility()) this.#draw(unit);
  }

  #draw(unit) {
    const { canvas, ratio, values } = this;
    const context = canvas.getContext('2d');
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, WIDTH, HEIGHT);
    const finite = values.filter(Number.isFinite);
    canvas.title = '';
    if (finite.length === 0) return;
    const [least, greatest] = [Math.min(...finite), Math.max(...finite)];
    canvas.title = `${number(least, 3)} … ${number(greatest, 3)} ${unit} in the last minute`;
    const span = greatest - least;
    const y = (value) => HEIGHT - 2 - (HEIGHT - 4) * (span > 0 ? (value - least) / span : 0.5);
    context.strokeStyle = getComputedStyle(canvas).color;
    context.lineWidth = 1.2;
    context.beginPath();
    const first = SAMPLES - values.length;
    let down = false;
    values.forEach((value, i) => {
      const x = ((first + i) / (SAMPLES - 1)) * (WIDTH - 2) + 1;
      if (!Number.isFinite(value)) down = false;
      else if (down) context.lineTo(x, y(value));
      else context.moveTo(x, y(value));
      down = Number.isFinite(value);
    });
    context.stroke();
  }
}
