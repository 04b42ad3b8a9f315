// SPDX-License-Identifier: Apache-2.0
// What this page has seen of a live run, in bounded memory: frames and the figures of its curves.
// What was undone by going back is forgotten.

const MOST_BYTES = 48 * 2 ** 20;
const MOST_SAMPLES = 20000;

const FRAME_ARRAYS = {
  pose: 'pose',
  velocity: 'velocity',
  com: 'com',
  cop: 'cop',
  goal_point: 'goalPoint',
  goal_target: 'goalTarget',
  contact_point: 'contactPoint',
  contact_normal: 'contactNormal',
  contact_force: 'contactForce',
  contact_geometry: 'contactGeometry',
};

/** Forgets what is not before `time`. */
function forgetFrom(list, time) {
  while (list.length > 0 && list.at(-1).time >= time) list.pop();
}

const isEven = (_, i) => i % 2 === 0;

export class Recorder {
  constructor(run, link) {
    this.run = run;
    this.frames = [];
    this.samples = [];
    this.bytes = 0;
    link.on('frame', () => this.#addFrame());
    link.on('status', (status) => this.#addSample(status));
  }

  #addFrame() {
    const { run } = this;
    const frame = { time: run.times[0], arrays: {} };
    for (const [name, member] of Object.entries(FRAME_ARRAYS)) frame.arrays[name] = run[member];
    forgetFrom(this.frames, frame.time);
    this.frames.push(frame);
    this.first?.();
    this.first = null;
    this.bytes += run.pose.buffer.byteLength;
    if (this.bytes < MOST_BYTES) return;
    this.frames = this.frames.filter(isEven);
    this.bytes = this.frames.reduce((sum, { arrays }) => sum + arrays.pose.buffer.byteLength, 0);
  }

  #addSample(status) {
    forgetFrom(this.samples, status.time);
    this.samples.push({ time: status.time, status });
    if (this.samples.length > MOST_SAMPLES) this.samples = this.samples.filter(isEven);
  }

  /** Calls back once there is something to save. */
  onFirst(callback) {
    this.first = callback;
  }

  /** {header, arrays} for packRun(). */
  contents() {
    const { run, frames } = this;
    const { live, arrays: listed, ...rest } = run.header;
    const arrays = {};
    // Meshes and images stay as they are.
    for (const name of Object.keys(listed))
      if (!/^(frame|series|contact)_|^(series\d|pose|velocity|com|cop|goal_)/.test(name))
        arrays[name] = run.array(name);
    arrays.frame_time = Float64Array.from(frames, ({ time }) => time);
    for (const name of Object.keys(FRAME_ARRAYS)) {
      const parts = frames.map((frame) => frame.arrays[name]);
      const whole = new parts[0].constructor(parts.reduce((sum, part) => sum + part.length, 0));
      let at = 0;
      for (const part of parts) {
        whole.set(part, at);
        at += part.length;
      }
      arrays[name] = whole;
    }
    const starts = new Uint32Array(frames.length + 1);
    frames.forEach(({ arrays: own }, i) => (starts[i + 1] = starts[i] + own.contact_point.length / 3));
    arrays.contact_start = starts;
    const [first, last] = [frames[0].time, frames.at(-1).time];
    const header = {
      ...rest,
      frames: { count: frames.length },
      duration: last,
      outcome: { kind: 'completed', message: '' },
      facts: [['seen', `a live run from ${first.toFixed(2)} s to ${last.toFixed(2)} s`]],
      series: { bucket: 1, groups: this.#curves(live, arrays) },
    };
    return { header, arrays };
  }

  /** Curves of the figures, a sample each status; their arrays go to `arrays`. */
  #curves(live, arrays) {
    const { samples } = this;
    arrays.series_time = Float64Array.from(samples, ({ time }) => time);
    let count = 0;
    const curve = (name, valueOf, limits = {}) => {
      const values = `series${count++}`;
      arrays[values] = Float32Array.from(samples, ({ status }) => valueOf(status) ?? NaN);
      return { name, values, ...limits };
    };
    const group = (name, unit, curves, scale = 'linear') => ({ name, unit, scale, curves });
    const joints = (unit) =>
      live.joints.flatMap(({ name, unit: own, lower, upper }, i) =>
        own === unit ? [curve(name, (status) => status.joints[i], { lower, upper })] : [],
      );
    const goals = [...new Set(samples.flatMap(({ status }) => status.errors.map(({ name }) => name)))];
    const errors = (unit) =>
      goals
        .map((name) => [name, samples.flatMap(({ status }) => status.errors).find((e) => e.name === name)])
        .filter(([, error]) => error.unit === unit)
        .map(([name]) => curve(name, ({ errors: now }) => now.find((e) => e.name === name)?.value));
    const units = new Set(samples.flatMap(({ status }) => status.errors.map(({ unit }) => unit)));
    return [
      group('Joint positions', 'rad', joints('rad')),
      group('Joint positions', 'm', joints('m')),
      ...[...units].map((unit) => group('Goal errors', unit, errors(unit))),
      group('Energy', 'J', [curve('total', ({ energy }) => energy)]),
      group('Constraints and iterations', '', [
        curve('contacts', ({ contacts }) => contacts),
        curve('rows', ({ rows }) => rows),
        curve('iterations', ({ iterations }) => iterations),
      ]),
      group('Time per step', 'µs', [
        curve('median', ({ step_us }) => step_us.p50),
        curve('p99', ({ step_us }) => step_us.p99),
      ]),
      group('Deepest penetration', 'm', [curve('penetration', ({ penetration }) => penetration)]),
    ].filter(({ curves }) => curves.length > 0);
  }
}
