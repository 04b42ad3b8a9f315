// SPDX-License-Identifier: Apache-2.0
// Contacts of the nearest frame: a dot each, and the force as an arrow on the body that moves.
//
// The run gives the force on geometry B; A feels the opposite. Where both move, both are drawn.
// Between frames a contact moves with its body.

import { Group } from 'three';
import { contactNames, largestForce, typicalForce } from '../data/run.js';
import {
  add,
  conjugate,
  multiply,
  positionOf,
  rotate,
  rotationOf,
  subtract,
} from '../data/transform.js';
import { Arrows, Dots } from './arrows.js';

export const CONTACT_COLOR = '#f08c00';
const MARKED_COLOR = '#d6336c';
export const MARGIN_COLOR = '#9aa5b1';

export class Contacts {
  constructor(run, size) {
    this.run = run;
    this.body = run.header.geometries.map((geometry) => geometry.body);
    const most = run.mostContacts();
    this.forces = new Arrows(2 * most, CONTACT_COLOR, 0.0075 * size);
    this.pressed = new Dots(most, CONTACT_COLOR, 0.013 * size);
    this.margin = new Dots(most, MARGIN_COLOR, 0.009 * size);
    this.mark = new Dots(1, MARKED_COLOR, 0.022 * size);
    this.marked = null; // the name of the contact that is marked
    this.points = new Group();
    this.points.add(this.pressed.group, this.margin.group, this.mark.group);
    this.group = new Group();
    this.group.add(this.forces.group, this.points);
    this.size = size;
    this.typical = run.typicalForce === undefined ? this.#typicalLargest() : null;
    this.scale = 1;
  }

  /** Metres of arrow for each newton. */
  get metresPerNewton() {
    return (0.22 * this.size * this.scale) / (this.typical ?? this.run.typicalForce);
  }

  /** Of a recorded run. */
  #typicalLargest() {
    const frames = Array.from({ length: this.run.frames }, (_, i) => largestForce(this.run, i));
    return typicalForce(frames.filter((most) => most > 0)) || 1;
  }

  update(time, poses) {
    const { run, body } = this;
    const frame = run.nearest(time);
    const moved = run.times[frame] !== time;
    const size = 7 * run.bodies.length;
    const then = run.pose.subarray(frame * size, (frame + 1) * size);
    const k = this.metresPerNewton;
    const marked =
      this.marked === null ? -1 : contactNames(run, frame).indexOf(this.marked);
    for (const set of [this.forces, this.pressed, this.margin, this.mark]) set.begin();
    for (let c = run.contactStart[frame]; c < run.contactStart[frame + 1]; ++c) {
      const bodyA = body[run.contactGeometry[2 * c]];
      const bodyB = body[run.contactGeometry[2 * c + 1]];
      let point = [0, 1, 2].map((i) => run.contactPoint[3 * c + i]);
      let force = [0, 1, 2].map((i) => run.contactForce[3 * c + i]);
      if (moved) {
        const carrier = bodyB !== 0 ? bodyB : bodyA;
        const turn = multiply(rotationOf(poses, carrier), conjugate(rotationOf(then, carrier)));
        point = add(
          positionOf(poses, carrier),
          rotate(turn, subtract(point, positionOf(then, carrier))),
        );
      }
      const [x, y, z] = point;
      if (c - run.contactStart[frame] === marked) this.mark.add(x, y, z);
      const isPressed = Math.hypot(...force) > 0;
      (isPressed ? this.pressed : this.margin).add(x, y, z);
      if (!isPressed) continue;
      force = force.map((f) => k * f);
      if (bodyB !== 0) this.forces.add(x, y, z, ...force);
      if (bodyA !== 0) this.forces.add(x, y, z, -force[0], -force[1], -force[2]);
    }
    for (const set of [this.forces, this.pressed, this.margin, this.mark]) set.end();
  }
}
