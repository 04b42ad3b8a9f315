// SPDX-License-Identifier: Apache-2.0
// A run as it goes: the one frame that is newest, in the form of a recorded run.

import { Run, largestForce, typicalForce } from '../data/run.js';

const MOST_CONTACTS = 512; // that are drawn
const LATELY = 300; // frames: five seconds

export class LiveRun extends Run {
  constructor(payload) {
    super(payload);
    this.live = this.header.live;
    this.steps = 0;
    this.paused = false;
    this.typicalForce = this.live.weight; // until something touches
    this.lately = []; // the largest force of each of the last frames with contact [N]
  }

  /** Takes a message of the server, in the layout of docs/reference/live.md. False: it is none. */
  take(buffer) {
    const magic = new TextDecoder().decode(new Uint8Array(buffer, 0, 8));
    if (magic !== 'SGFRAME1') return false;
    const view = new DataView(buffer);
    const [bodies, goals, contacts, flags] = [24, 28, 32, 36].map((o) => view.getUint32(o, true));
    let offset = 40;
    const next = (Kind, count) => {
      const array = new Kind(buffer, offset, count);
      offset += array.byteLength;
      return array;
    };
    this.times = new Float64Array([view.getFloat64(8, true)]);
    this.start = this.end = this.times[0];
    this.steps = view.getFloat64(16, true);
    this.paused = (flags & 1) === 1;
    this.pose = next(Float32Array, 7 * bodies);
    this.velocity = next(Float32Array, 6 * bodies);
    this.com = next(Float32Array, 3);
    this.cop = next(Float32Array, 3);
    this.goalPoint = next(Float32Array, 3 * goals);
    this.goalTarget = next(Float32Array, 3 * goals);
    this.contactPoint = next(Float32Array, 3 * contacts);
    this.contactNormal = next(Float32Array, 3 * contacts);
    this.contactForce = next(Float32Array, 3 * contacts);
    this.contactGeometry = next(Uint32Array, 2 * contacts);
    this.contactStart = [0, Math.min(contacts, MOST_CONTACTS)];
    if (!this.paused) this.#weighContacts();
    return true;
  }

  /** What arrows are scaled by follows what acts, as it is of the whole run in a replay. */
  #weighContacts() {
    const most = largestForce(this, 0);
    if (most > 0) this.lately.push(most);
    if (this.lately.length > LATELY) this.lately.shift();
    const typical = typicalForce(this.lately);
    if (typical > 0) this.typicalForce *= (typical / this.typicalForce) ** 0.05;
  }

  mostContacts() {
    return MOST_CONTACTS;
  }
}
