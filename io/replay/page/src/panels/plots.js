// SPDX-License-Identifier: Apache-2.0
// The groups of plots, in step with the clock and with each other.
//
// Click or drag seeks; the wheel, or a drag with shift, zooms in time; double-click resets.

import { element, iconButton } from '../app/dom.js';
import { save } from '../app/save.js';
import { curvesText } from './curves_file.js';
import { Plot } from './plot.js';

const SHOWN_AT_FIRST = ['Joint positions', 'Controls', 'Contact normal forces', 'Goal errors'];

export class Plots {
  constructor(host, run, clock, settings, selection) {
    this.run = run;
    this.clock = clock;
    this.settings = settings;
    this.selection = selection;
    this.seriesTime = run.array('series_time');
    // Samples that two entries stand for; 1: every sample is there.
    this.bucket = run.header.series.bucket ?? 1;
    this.full = [run.start, Math.max(run.end, run.start + run.header.timestep)];
    this.zoom = this.full;
    this.plots = run.header.series.groups.map((group) => new Plot(this, group));
    this.shown = new Set();
    this.chips = this.plots.map((plot, i) =>
      element(
        'button',
        {
          type: 'button',
          class: 'chip',
          'aria-pressed': 'false',
          title: i < 9 ? `Show or hide (${i + 1})` : 'Show or hide',
          onclick: () => this.toggle(i),
        },
        i < 9 ? element('kbd', {}, String(i + 1)) : null,
        this.#title(i),
      ),
    );
    this.limitsButton = iconButton(
      'limits',
      'Limits of all curves (m)',
      () => settings.set('limits', !settings.get('limits')),
      { 'aria-pressed': 'false' },
    );
    this.list = element('div', { class: 'plot-list scroll' });
    this.hint = element(
      'p',
      { class: 'quiet none' },
      this.plots.length > 0 ? 'Choose what to plot above.' : 'This run has no curves.',
    );
    this.list.append(this.hint);
    host.append(
      element(
        'div',
        { class: 'panel-head' },
        element(
          'div',
          { class: 'chips', role: 'group', 'aria-label': 'Groups of plots' },
          ...this.chips,
        ),
        element(
          'div',
          { class: 'buttons' },
          this.limitsButton,
          iconButton('save', 'Save the curves as a table (.csv)', () =>
            save(`${run.header.model || 'run'}.csv`, new Blob([curvesText(run)], { type: 'text/csv' })),
          ),
          iconButton('reset', 'All time (double-click a plot)', () => this.setZoom(this.full)),
        ),
      ),
      this.list,
    );
    new ResizeObserver(() => this.plots.forEach((plot) => plot.resize())).observe(this.list);
    for (const [i, plot] of this.plots.entries())
      if (SHOWN_AT_FIRST.includes(plot.group.name) && this.shown.size < 4) this.toggle(i);
    if (this.shown.size === 0 && this.plots.length > 0) this.toggle(0);
    this.valuesAt = 0;
    clock.on('time', () => this.#showTime());
    clock.on('playing', () => this.#showTime());
    settings.on('limits', (limits) => {
      this.limitsButton.setAttribute('aria-pressed', limits);
      this.restyle();
    });
    settings.on('theme', () => this.restyle());
    selection.on('change', () => this.restyle());
  }

  /** Two groups of one name differ by their unit. */
  #title(i) {
    const { name, unit } = this.plots[i].group;
    const isUnique = this.plots.every((plot, k) => k === i || plot.group.name !== name);
    return isUnique ? name : `${name} [${unit}]`;
  }

  get theme() {
    return this.settings.get('theme');
  }

  get limits() {
    return this.settings.get('limits');
  }

  toggle(i, show = !this.shown.has(i)) {
    const plot = this.plots[i];
    if (!plot) return;
    this.chips[i].setAttribute('aria-pressed', show);
    if (show) {
      this.shown.add(i);
      const after = this.plots.find((other, k) => k > i && this.shown.has(k));
      this.list.insertBefore(plot.node, after?.node ?? null);
      plot.build();
      plot.resize();
      plot.restyle();
      plot.showValues(this.#entry());
    } else {
      this.shown.delete(i);
      plot.node.remove();
    }
    this.hint.hidden = this.shown.size > 0;
  }

  /** Shows the groups of these names and no others. */
  showOnly(names) {
    this.plots.forEach((plot, i) => this.toggle(i, names.includes(plot.group.name)));
  }

  #visible() {
    return [...this.shown].map((i) => this.plots[i]);
  }

  /** The curves and limits of the plots that are shown. */
  drawn() {
    return this.#visible().map((plot) => plot.drawn());
  }

  restyle() {
    for (const plot of this.#visible()) plot.restyle();
  }

  setZoom([min, max]) {
    const [start, end] = this.full;
    const width = Math.min(end - start, Math.max(max - min, 4 * this.run.header.timestep));
    const low = Math.min(Math.max(min, start), end - width);
    this.zoom = [low, low + width];
    for (const plot of this.#visible()) plot.setZoom(this.zoom);
  }

  /** The entry of the series at the time shown. */
  #entry() {
    const { seriesTime } = this;
    let low = 0;
    let high = seriesTime.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (seriesTime[middle] <= this.clock.time + 1e-12) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  #showTime() {
    for (const plot of this.#visible()) plot.showTime();
    // Numbers that change at every picture cannot be read.
    const now = performance.now();
    if (this.clock.playing && now - this.valuesAt < 120) return;
    this.valuesAt = now;
    const entry = this.#entry();
    for (const plot of this.#visible()) plot.showValues(entry);
  }

  /** The pointer on one plot. */
  listen(plot) {
    const { over } = plot;
    const timeAt = (event) => plot.posToVal(event.clientX - over.getBoundingClientRect().left, 'x');
    over.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      over.setPointerCapture(event.pointerId);
      if (event.shiftKey) this.#drag(over, event, this.#selecting(plot, event));
      else this.#drag(over, event, this.#seeking(timeAt, event));
    });
    over.addEventListener('dblclick', () => this.setZoom(this.full));
    over.addEventListener(
      'wheel',
      (event) => {
        event.preventDefault();
        const [min, max] = this.zoom;
        if (Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
          const shift = (event.deltaX / over.clientWidth) * (max - min);
          this.setZoom([min + shift, max + shift]);
        } else {
          const at = timeAt(event);
          const factor = Math.exp(Math.max(-1, Math.min(1, event.deltaY * 0.002)));
          this.setZoom([at - (at - min) * factor, at + (max - at) * factor]);
        }
      },
      { passive: false },
    );
  }

  #drag(over, event, { move, end }) {
    const finish = () => {
      over.removeEventListener('pointermove', move);
      end();
    };
    over.addEventListener('pointermove', move);
    over.addEventListener('lostpointercapture', finish, { once: true });
    move(event);
  }

  #seeking(timeAt) {
    const wasPlaying = this.clock.playing;
    this.clock.pause();
    return {
      move: (event) => this.clock.seek(timeAt(event)),
      end: () => wasPlaying && this.clock.time < this.run.end && this.clock.play(),
    };
  }

  #selecting(plot, event) {
    const { over } = plot;
    const place = (e) =>
      Math.min(over.clientWidth, Math.max(0, e.clientX - over.getBoundingClientRect().left));
    const from = place(event);
    let to = from;
    return {
      move: (e) => {
        to = place(e);
        plot.setSelect(
          {
            left: Math.min(from, to),
            width: Math.abs(to - from),
            top: 0,
            height: over.clientHeight,
          },
          false,
        );
      },
      end: () => {
        const [low, high] = [Math.min(from, to), Math.max(from, to)].map((x) =>
          plot.posToVal(x, 'x'),
        );
        plot.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
        if (Math.abs(to - from) > 3) this.setZoom([low, high]);
      },
    };
  }
}
