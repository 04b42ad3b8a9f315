// SPDX-License-Identifier: Apache-2.0
// Panels that open and close, and the splitters between them.
//
// On a wide window links, view and plots stand side by side; on a narrow one the plots are below
// the view and the links lie over it.

import { byId } from './dom.js';

const NARROW = window.matchMedia('(max-width: 900px)');
const LIMITS = { links: [170, 520], plots: [280, 1400], plotsBelow: [120, 900] };

export class Layout {
  constructor() {
    this.root = document.documentElement;
    this.panels = { links: byId('links'), plots: byId('plots') };
    this.buttons = { links: byId('toggle-links'), plots: byId('toggle-plots') };
    for (const name of ['links', 'plots'])
      this.buttons[name].addEventListener('click', () => this.toggle(name));
    this.#splitter(byId('split-links'), (event) => this.#setSize('links', event.clientX));
    this.#splitter(byId('split-plots'), (event) =>
      NARROW.matches
        ? this.#setSize('plotsBelow', byId('transport').getBoundingClientRect().top - event.clientY)
        : this.#setSize('plots', window.innerWidth - event.clientX),
    );
    const adapt = () => {
      this.open('links', !NARROW.matches);
      byId('split-plots').setAttribute(
        'aria-orientation',
        NARROW.matches ? 'horizontal' : 'vertical',
      );
    };
    NARROW.addEventListener('change', adapt);
    adapt();
    this.open('plots', true);
  }

  isOpen(name) {
    return !this.panels[name].hidden;
  }

  open(name, show) {
    this.panels[name].hidden = !show;
    byId(`split-${name}`).hidden = !show;
    this.buttons[name].setAttribute('aria-pressed', show);
  }

  toggle(name) {
    this.open(name, !this.isOpen(name));
  }

  #setSize(name, pixels) {
    const [least, most] = LIMITS[name];
    const room = name === 'plotsBelow' ? window.innerHeight - 260 : window.innerWidth - 260;
    this.root.style.setProperty(
      `--${name.toLowerCase()}`,
      `${Math.round(Math.max(least, Math.min(most, room, pixels)))}px`,
    );
  }

  #splitter(bar, place) {
    bar.addEventListener('pointerdown', (event) => {
      bar.setPointerCapture(event.pointerId);
      bar.addEventListener('pointermove', place);
      bar.addEventListener(
        'lostpointercapture',
        () => bar.removeEventListener('pointermove', place),
        { once: true },
      );
      event.preventDefault();
    });
    bar.addEventListener('keydown', (event) => {
      const step = {
        ArrowLeft: [-16, 0],
        ArrowRight: [16, 0],
        ArrowUp: [0, -16],
        ArrowDown: [0, 16],
      }[event.key];
      if (!step) return;
      const { left, top, width, height } = bar.getBoundingClientRect();
      place({ clientX: left + width / 2 + step[0], clientY: top + height / 2 + step[1] });
      event.preventDefault();
      event.stopPropagation();
    });
  }
}
