// SPDX-License-Identifier: Apache-2.0
// A recorded run: where every body and link is at any time, and what touches it.
//
// Between two frames bodies are interpolated on SE(3). Positions here are relative to `origin`,
// as in the payload; what leaves the page through linkPose() is in the world.

import { add, cross, interpolate, placed, rotate, rotationOf } from './transform.js';

/**
 * The contacts of a frame by names that follow them from frame to frame: who touches whom, and which
 * of the contacts of that pair it is.
 */
export function contactNames(run, frame) {
  const counts = new Map();
  const names = [];
  for (let c = run.contactStart[frame]; c < run.contactStart[frame + 1]; ++c) {
    const pair = `${run.contactGeometry[2 * c]} ${run.contactGeometry[2 * c + 1]}`;
    const nth = counts.get(pair) ?? 0;
    counts.set(pair, nth + 1);
    names.push(`${pair} ${nth}`);
  }
  return names;
}

/** The largest contact force of a frame [N]; 0 without contact. */
export function largestForce({ contactStart, contactForce }, frame) {
  let most = 0;
  for (let c = contactStart[frame]; c < contactStart[frame + 1]; ++c)
    most = Math.max(
      most,
      Math.hypot(contactForce[3 * c], contactForce[3 * c + 1], contactForce[3 * c + 2]) || 0,
    );
  return most;
}

/**
 * The largest force of a frame, of which four fifths of the frames with contact have no more: a
 * blow is short, a grip is not. Undefined without any.
 */
export function typicalForce(largest) {
  return [...largest].sort((a, b) => a - b)[Math.floor(0.8 * largest.length)];
}

export class Run {
  constructor({ header, array }) {
    this.header = header;
    this.array = array;
    this.bodies = header.bodies;
    this.links = header.links;
    this.linkByName = new Map(this.links.map((link) => [link.name, link]));
    this.times = array('frame_time');
    this.frames = header.frames.count;
    this.start = this.times[0];
    this.end = this.times[this.frames - 1];
    this.pose = array('pose');
    this.velocity = array('velocity');
    this.com = array('com');
    this.cop = array('cop');
    this.goalPoint = array('goal_point');
    this.goalTarget = array('goal_target');
    this.contactStart = array('contact_start');
    this.contactPoint = array('contact_point');
    this.contactForce = array('contact_force');
    this.contactNormal = array('contact_normal');
    this.contactGeometry = array('contact_geometry');
  }

  /** The last frame at or before `time`, and how far it is to the next one (0 to 1). */
  bracket(time) {
    let low = 0;
    let high = this.frames - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.times[middle] <= time) low = middle;
      else high = middle - 1;
    }
    if (low === this.frames - 1 || time <= this.times[low]) return { i: low, s: 0 };
    return { i: low, s: (time - this.times[low]) / (this.times[low + 1] - this.times[low]) };
  }

  /** The frame that is nearest in time. */
  nearest(time) {
    const { i, s } = this.bracket(time);
    return s > 0.5 ? i + 1 : i;
  }

  /** Poses of all bodies at `time`, into `out` (bodies × 7). */
  posesAt(time, out) {
    const { i, s } = this.bracket(time);
    const size = 7 * this.bodies.length;
    for (let o = 0; o < size; o += 7) {
      if (s === 0) for (let k = 0; k < 7; ++k) out[o + k] = this.pose[i * size + o + k];
      else interpolate(this.pose, i * size + o, (i + 1) * size + o, s, out, o);
    }
    return out;
  }

  /** One of the `count` vectors of each frame, linearly interpolated; null where not given. */
  vectorAt(array, time, count = 1, which = 0) {
    const { i, s } = this.bracket(time);
    const at = (frame, k) => array[3 * (frame * count + which) + k];
    const out = [0, 1, 2].map((k) => (s === 0 ? at(i, k) : (1 - s) * at(i, k) + s * at(i + 1, k)));
    if (out.every(Number.isFinite)) return out;
    const near = [0, 1, 2].map((k) => at(this.nearest(time), k));
    return near.every(Number.isFinite) ? near : null;
  }

  /** Pose of a link for the given poses of the bodies, in the world. */
  linkPose(link, poses) {
    const { p, q } = placed(poses, link.body, link);
    const length = Math.hypot(...q);
    return { position: add(p, this.header.origin), quaternion: q.map((x) => x / length) };
  }

  /** Velocity of a link's origin and angular velocity, world axes. */
  linkVelocity(link, time, poses) {
    const of = (offset) => this.vectorAt(this.velocity, time, 2 * this.bodies.length, offset);
    const linear = of(2 * link.body) ?? [0, 0, 0];
    const angular = of(2 * link.body + 1) ?? [0, 0, 0];
    const arm = rotate(rotationOf(poses, link.body), link.p);
    return { linear: add(linear, cross(angular, arm)), angular };
  }

  /** The longest list of contacts of a frame. */
  mostContacts() {
    let most = 0;
    for (let i = 0; i < this.frames; ++i)
      most = Math.max(most, this.contactStart[i + 1] - this.contactStart[i]);
    return most;
  }
}
