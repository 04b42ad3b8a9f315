// SPDX-License-Identifier: Apache-2.0
// The contacts of the time shown: who touches whom, where, how hard, and how fast it slips. A click
// on a row marks the contact in the view, and its row as long as the pair touches.

import { element } from '../app/dom.js';
import { contactNames } from '../data/run.js';
import { cross, norm, positionOf, subtract } from '../data/transform.js';

const MOST_ROWS = 40;
const COLUMNS = ['Pair', 'Point [m]', 'Normal [N]', 'Friction [N]', 'Slip [m/s]'];

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
/** What is left of a vector beside its part along a unit vector. */
const across = (v, n) => subtract(v, n.map((x) => x * dot(v, n)));

export class ContactTable {
  constructor(host, run, stage) {
    this.run = run;
    this.stage = stage;
    this.body = element('tbody');
    this.title = element('summary', {}, 'Contacts');
    this.node = element(
      'details',
      { class: 'contacts' },
      this.title,
      element(
        'div',
        { class: 'scroll' },
        element(
          'table',
          {},
          element('thead', {}, element('tr', {}, ...COLUMNS.map((name) => element('th', {}, name)))),
          this.body,
        ),
      ),
    );
    this.rows = [];
    this.node.addEventListener('toggle', () => this.update(this.time, this.poses));
    host.append(this.node);
  }

  /** Velocity of the body's point there, world axes. */
  #velocity(frame, body, point) {
    const { run } = this;
    const at = 6 * (frame * run.bodies.length + body);
    const [linear, angular] = [0, 3].map((o) => [0, 1, 2].map((k) => run.velocity[at + o + k]));
    const size = 7 * run.bodies.length;
    const poses = run.pose.subarray(frame * size, (frame + 1) * size);
    const turn = cross(angular, subtract(point, positionOf(poses, body)));
    return linear.map((x, k) => x + turn[k]);
  }

  #contact(frame, c) {
    const { run } = this;
    const triple = (array) => [0, 1, 2].map((k) => array[3 * c + k]);
    const [a, b] = [0, 1].map((k) => run.header.geometries[run.contactGeometry[2 * c + k]]);
    const [point, normal, force] = [run.contactPoint, run.contactNormal, run.contactForce].map(triple);
    const moves = subtract(this.#velocity(frame, b.body, point), this.#velocity(frame, a.body, point));
    return {
      pair: `${a.link || a.name} – ${b.link || b.name}`,
      point: point.map((x, k) => x + run.header.origin[k]),
      normal: dot(force, normal),
      friction: norm(across(force, normal)),
      slip: norm(across(moves, normal)),
    };
  }

  update(time, poses) {
    [this.time, this.poses] = [time, poses];
    if (!this.node.open || time === undefined) return;
    const { run } = this;
    const frame = run.nearest(time);
    const first = run.contactStart[frame];
    const count = run.contactStart[frame + 1] - first;
    this.title.textContent = `Contacts (${count})`;
    this.names = contactNames(run, frame);
    const shown = Math.min(count, MOST_ROWS);
    while (this.rows.length < shown) this.#addRow();
    this.rows.forEach(({ row, cells }, i) => {
      row.hidden = i >= shown;
      if (row.hidden) return;
      const { pair, point, normal, friction, slip } = this.#contact(frame, first + i);
      const texts = [
        pair,
        point.map((x) => x.toFixed(3)).join(' '),
        normal.toFixed(1),
        friction.toFixed(1),
        slip.toFixed(3),
      ];
      texts.forEach((text, k) => (cells[k].textContent = text));
      row.title = pair;
      row.setAttribute('aria-selected', this.stage?.contacts.marked === this.names[i]);
    });
  }

  #addRow() {
    const index = this.rows.length;
    const cells = COLUMNS.map(() => element('td'));
    const row = element(
      'tr',
      {
        tabindex: 0,
        onclick: () => this.#mark(index),
        onkeydown: (event) => event.key === 'Enter' && this.#mark(index),
      },
      ...cells,
    );
    this.rows.push({ row, cells });
    this.body.append(row);
  }

  #mark(index) {
    const { stage } = this;
    if (stage) {
      const name = this.names[index];
      stage.contacts.marked = stage.contacts.marked === name ? null : name;
      stage.moveTo(stage.time);
    }
    this.update(this.time, this.poses);
  }
}
