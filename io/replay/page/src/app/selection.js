// SPDX-License-Identifier: Apache-2.0
// The link that is looked at, and the joint that moves it. Emits `change`.

import { Emitter } from './emitter.js';

export class Selection extends Emitter {
  constructor(run) {
    super();
    this.run = run;
    this.link = null;
  }

  /** By name; null for none. A shape of the world that is no link selects nothing. */
  select(name) {
    const link = name == null ? null : (this.run.linkByName.get(name) ?? null);
    if (link === this.link) return;
    this.link = link;
    this.emit('change', link);
  }

  get name() {
    return this.link?.name ?? null;
  }

  get body() {
    return this.link ? this.run.bodies[this.link.body] : null;
  }

  /** Whether a curve is of the selected link: of its joint, its body or itself. */
  concerns(curve) {
    if (!this.link) return false;
    const { joint, name } = this.body;
    const first = curve.name.replace(/\.[^.]*$/, '');
    return [joint, name, this.link.name].some(
      (own) =>
        own !== '' && (curve.name === own || first === own || curve.name.endsWith(` ${own}`)),
    );
  }
}
