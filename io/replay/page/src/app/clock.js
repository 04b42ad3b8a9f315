// SPDX-License-Identifier: Apache-2.0
// The time that the page shows, and how it passes. Emits `time`, `playing`, `speed`, `loop`.

import { Emitter } from './emitter.js';

export const SPEEDS = [1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2, 4, 8];

export class Clock extends Emitter {
  constructor(run) {
    super();
    this.run = run;
    this.time = run.start;
    this.playing = false;
    this.speed = 1;
    this.loop = false;
    this.last = 0;
  }

  seek(time) {
    const clamped = Math.min(this.run.end, Math.max(this.run.start, Number(time) || 0));
    if (clamped === this.time) return;
    this.time = clamped;
    this.emit('time', clamped);
  }

  toStart() {
    this.seek(this.run.start);
  }

  toEnd() {
    this.seek(this.run.end);
  }

  play() {
    if (this.playing || this.run.end === this.run.start) return;
    if (this.time >= this.run.end) this.seek(this.run.start);
    this.playing = true;
    this.last = performance.now();
    this.emit('playing', true);
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.emit('playing', false);
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  /** To be called for every picture. */
  tick(now) {
    if (!this.playing) return;
    // After a hidden tab, go on from about where it was.
    const elapsed = Math.min(0.5, Math.max(0, (now - this.last) / 1000));
    this.last = now;
    const time = this.time + elapsed * this.speed;
    if (time < this.run.end) {
      this.seek(time);
    } else if (this.loop) {
      this.seek(this.run.start);
    } else {
      this.seek(this.run.end);
      this.pause();
    }
  }

  /** To the next frame that was recorded, or the one before. */
  step(count) {
    this.pause();
    const { i, s } = this.run.bracket(this.time);
    const frame = count > 0 ? i + count : s > 0 ? i + 1 + count : i + count;
    this.frame(frame);
  }

  frame(index) {
    this.seek(this.run.times[Math.min(this.run.frames - 1, Math.max(0, Math.round(index)))]);
  }

  setSpeed(speed) {
    this.speed = Math.min(SPEEDS.at(-1), Math.max(SPEEDS[0], speed));
    this.emit('speed', this.speed);
  }

  /** One notch faster or slower. */
  faster(notches) {
    const nearest = SPEEDS.reduce(
      (best, s, i) =>
        Math.abs(Math.log(s / this.speed)) < Math.abs(Math.log(SPEEDS[best] / this.speed))
          ? i
          : best,
      0,
    );
    this.setSpeed(SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, nearest + notches))]);
  }

  setLoop(loop) {
    this.loop = loop;
    this.emit('loop', loop);
  }
}
