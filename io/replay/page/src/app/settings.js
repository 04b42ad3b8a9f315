// SPDX-License-Identifier: Apache-2.0
// What the user has chosen to see. Each change is emitted under its own name.

import { Emitter } from './emitter.js';

export const MODES = ['visual', 'collision', 'both'];

/** Marks in the view: key, name, what the picture of it is. */
export const MARKS = [
  ['forces', 'Contact forces'],
  ['contacts', 'Contact points'],
  ['com', 'Centre of mass'],
  ['cop', 'Centre of pressure'],
  ['goals', 'Goals'],
  ['axes', 'Frame of the selected link'],
  ['path', 'Path of the selected link'],
];

export class Settings extends Emitter {
  constructor(run) {
    super();
    const dark = window.matchMedia('(prefers-color-scheme: dark)');
    this.values = {
      mode: run.header.visuals.some((visual) => visual.shape.kind !== 'plane')
        ? 'visual'
        : 'collision',
      theme: dark.matches ? 'dark' : 'light',
      follow: null,
      forceScale: 1,
      limits: false,
      action: 'drag',
      jerkTime: 0, // of a minimum-jerk line that a dragged point follows [s]; 0: a spring-damper
      pins: false,
      ...Object.fromEntries(MARKS.map(([key]) => [key, true])),
    };
    this.themeChosen = false;
    dark.addEventListener('change', (event) => {
      if (!this.themeChosen) this.set('theme', event.matches ? 'dark' : 'light');
    });
  }

  get(name) {
    return this.values[name];
  }

  set(name, value) {
    if (!(name in this.values)) throw new Error(`there is no setting "${name}"`);
    if (this.values[name] === value) return;
    this.values[name] = value;
    this.emit(name, value);
  }

  toggleTheme() {
    this.themeChosen = true;
    this.set('theme', this.get('theme') === 'dark' ? 'light' : 'dark');
  }

  nextMode() {
    this.set('mode', MODES[(MODES.indexOf(this.get('mode')) + 1) % MODES.length]);
  }
}
