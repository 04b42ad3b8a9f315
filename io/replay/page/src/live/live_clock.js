// SPDX-License-Identifier: Apache-2.0
// The clock of a live run: the simulation's. Emits `time`, `playing`, as the clock of a replay.

import { Emitter } from '../app/emitter.js';

export const FACTORS = [0.1, 0.25, 0.5, 1, 2, 4];

export class LiveClock extends Emitter {
  constructor(run, link) {
    super();
    this.run = run;
    this.link = link;
    this.time = run.start;
    this.playing = true;
    this.factor = 1;
    link.on('frame', () => {
      this.time = run.start;
      this.#setPlaying(!run.paused);
      this.emit('time', this.time);
    });
    link.on('status', (status) => {
      this.factor = status.factor;
      this.#setPlaying(!status.paused);
    });
  }

  #setPlaying(playing) {
    if (playing === this.playing) return;
    this.playing = playing;
    this.emit('playing', playing);
  }

  play() {
    return this.link.tell({ pause: { on: false } });
  }

  pause() {
    return this.link.tell({ pause: { on: true } });
  }

  toggle() {
    return this.playing ? this.pause() : this.play();
  }

  /** Steps of a paused run; back goes a second back. */
  step(count) {
    if (count < 0) return this.link.tell({ back: { seconds: 1 } });
    return this.playing ? this.pause() : this.link.tell({ advance: { count } });
  }

  /** The one place in time that a live run has besides the present is its start. */
  toStart() {
    return this.link.tell({ reset: {} });
  }
  toEnd() {}

  seek(time) {
    if (time <= 0) this.toStart();
  }

  /** One notch faster or slower. */
  faster(notches) {
    const i = FACTORS.findIndex((factor) => factor >= this.factor - 1e-9);
    const next = FACTORS[Math.max(0, Math.min(FACTORS.length - 1, i + notches))];
    return this.link.tell({ factor: { value: next } });
  }

  frame() {}
  setLoop() {}
  setSpeed(value) {
    return this.link.tell({ factor: { value } });
  }

  tick() {
    this.link.tick();
  }
}
