// SPDX-License-Identifier: Apache-2.0
// One group of curves over time, with its legend, its limits and the time cursor.

import uPlot from 'uplot';
import { element, number } from '../app/dom.js';
import { curveColor } from './colors.js';
import { nearLimits } from './limits.js';

const HEIGHT = 168;

/** uPlot draws null as a gap, and has no logarithm of what is not positive. */
function drawable(values, logarithmic) {
  const isGap = logarithmic ? (x) => !(x > 0 && x < Infinity) : (x) => !Number.isFinite(x);
  return values.some(isGap) ? Array.from(values, (x) => (isGap(x) ? null : x)) : values;
}

export class Plot {
  /** `panel` knows time, zoom, theme, selection and whether limits are to be shown. */
  constructor(panel, group) {
    this.panel = panel;
    this.group = group;
    this.logarithmic = group.scale === 'log';
    this.curves = group.curves.map((curve, i) => ({
      ...curve,
      index: i,
      shown: true,
      values: panel.run.array(curve.values),
    }));
    for (const curve of this.curves) curve.near = nearLimits(curve);
    this.hovered = null;
    this.limitLines = [];
    this.chart = element('div', { class: 'chart' });
    this.legend = element('ul', { class: 'legend', 'aria-label': `Curves of ${group.name}` });
    this.node = element(
      'section',
      { class: 'plot', 'aria-label': group.name },
      element(
        'h3',
        {},
        group.name,
        group.unit ? element('span', { class: 'unit' }, ` [${group.unit}]`) : null,
      ),
      this.chart,
      this.legend,
    );
    for (const curve of this.curves) this.#addLegend(curve);
    this.cursor = element('div', { class: 'time-cursor' });
  }

  #addLegend(curve) {
    curve.value = element('span', { class: 'value' });
    curve.swatch = element('span', { class: 'swatch' });
    curve.button = element(
      'button',
      {
        type: 'button',
        'aria-pressed': 'true',
        title: `${curve.name}: click hides or shows, double-click shows it alone`,
        onclick: () => this.#toggle(curve),
        ondblclick: () => this.#alone(curve),
        onpointerenter: () => this.#hover(curve),
        onpointerleave: () => this.#hover(null),
      },
      curve.swatch,
      element('span', { class: 'name' }, curve.name),
      curve.value,
    );
    this.legend.append(element('li', {}, curve.button));
  }

  #toggle(curve) {
    this.#show((other) => (other === curve ? !other.shown : other.shown));
  }

  #alone(curve) {
    const isAlone = this.curves.every((other) => other.shown === (other === curve));
    this.#show((other) => isAlone || other === curve);
  }

  #show(accept) {
    for (const curve of this.curves) {
      curve.shown = accept(curve);
      curve.button.setAttribute('aria-pressed', curve.shown);
    }
    this.plot?.batch(() =>
      this.curves.forEach((curve, i) => this.plot.setSeries(i + 1, { show: curve.shown }, false)),
    );
  }

  #hover(curve) {
    this.hovered = curve;
    this.restyle();
  }

  /** Curves that stand out: the hovered one, else those of the selected link. */
  #emphasised() {
    if (this.hovered) return [this.hovered];
    return this.curves.filter((curve) => curve.shown && this.panel.selection.concerns(curve));
  }

  /** Limits that are drawn: those near their curves; all of chosen curves, or where asked for. */
  #limited() {
    const chosen = this.#emphasised();
    return this.curves
      .filter((curve) => curve.shown)
      .map((curve) => ({
        curve,
        ...(this.panel.limits || chosen.includes(curve) ? curve : curve.near),
      }))
      .filter(({ lower, upper }) => lower !== undefined || upper !== undefined);
  }

  build() {
    if (this.plot) return;
    const { panel } = this;
    const style = (name) => () => getComputedStyle(document.documentElement).getPropertyValue(name);
    const axis = (options) => ({
      stroke: style('--quiet'),
      grid: { stroke: style('--grid'), width: 1 },
      ticks: { show: false },
      font: '11px system-ui, sans-serif',
      ...options,
    });
    this.plot = new uPlot(
      {
        width: Math.max(100, this.chart.clientWidth),
        height: HEIGHT,
        padding: [8, 16, 0, 0],
        legend: { show: false },
        cursor: { show: false },
        scales: {
          x: { time: false },
          y: this.logarithmic ? { distr: 3 } : { range: (u, low, high) => this.#range(low, high) },
        },
        axes: [
          axis({
            size: 24,
            gap: 3,
            space: 70,
            values: (u, ticks) =>
              ticks.map((t, i) => `${number(t, 6)}${i === ticks.length - 1 ? ' s' : ''}`),
          }),
          axis({
            size: 56,
            gap: 4,
            space: 26,
            values: (u, ticks) => ticks.map((t) => (t == null ? '' : number(t, 4))),
          }),
        ],
        series: [
          {},
          ...this.curves.map((curve) => ({
            label: curve.name,
            show: curve.shown,
            width: 1.4,
            points: { show: false },
            spanGaps: false,
            pxAlign: 0,
            stroke: () => curveColor(curve.index, panel.theme),
          })),
        ],
        hooks: { drawAxes: [() => this.#drawLimits()], setSize: [() => this.showTime()] },
      },
      [panel.seriesTime, ...this.curves.map((curve) => drawable(curve.values, this.logarithmic))],
      this.chart,
    );
    this.plot.over.append(this.cursor);
    this.plot.over.classList.add('over');
    panel.listen(this.plot);
    this.setZoom(panel.zoom);
    this.restyle();
  }

  #range(low, high) {
    if (low == null || (low === 0 && high === 0)) return [-1, 1];
    // Limits far beyond the curves would flatten them, unless they were asked for.
    for (const { curve, lower, upper } of this.#limited()) {
      const { near } = curve;
      if (lower !== undefined && (this.panel.limits || near.lower !== undefined))
        low = Math.min(low, lower);
      if (upper !== undefined && (this.panel.limits || near.upper !== undefined))
        high = Math.max(high, upper);
    }
    return uPlot.rangeNum(low, high, 0.08, true);
  }

  /** Dashed lines at the limits, a shade beyond them when they are of one curve. */
  #drawLimits() {
    const { ctx, bbox } = this.plot;
    const limited = this.#limited();
    this.limitLines = [];
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    for (const { curve, lower, upper } of limited) {
      const color = curveColor(curve.index, this.panel.theme);
      for (const [limit, end] of [
        [lower, bbox.top + bbox.height],
        [upper, bbox.top],
      ]) {
        if (limit === undefined) continue;
        const y = this.plot.valToPos(limit, 'y', true);
        if (limited.length <= 2) {
          ctx.globalAlpha = 0.07;
          ctx.fillStyle = color;
          ctx.fillRect(
            bbox.left,
            Math.min(y, end),
            bbox.width,
            end === bbox.top ? Math.max(0, y - end) : Math.max(0, end - y),
          );
        }
        ctx.globalAlpha = 0.75;
        ctx.strokeStyle = color;
        ctx.lineWidth = window.devicePixelRatio;
        ctx.setLineDash([6 * window.devicePixelRatio, 4 * window.devicePixelRatio]);
        ctx.beginPath();
        ctx.moveTo(bbox.left, y);
        ctx.lineTo(bbox.left + bbox.width, y);
        ctx.stroke();
        this.limitLines.push({ curve: curve.name, value: this.plot.posToVal(y, 'y', true) });
      }
    }
    ctx.restore();
  }

  /** After a change of theme, selection or limits. */
  restyle() {
    const chosen = this.#emphasised();
    this.curves.forEach((curve, i) => {
      const stands = chosen.includes(curve);
      curve.swatch.style.background = curveColor(curve.index, this.panel.theme);
      curve.button.classList.toggle('chosen', stands && chosen.length < this.curves.length);
      if (!this.plot) return;
      this.plot.series[i + 1].width = stands ? 2.4 : 1.4;
      this.plot.series[i + 1].alpha = chosen.length === 0 || stands ? 1 : 0.22;
    });
    // Limits that are shown or not change the range of y.
    this.setZoom(this.panel.zoom);
  }

  setZoom([min, max]) {
    this.plot?.setScale('x', { min, max });
    this.showTime();
  }

  resize() {
    const width = this.chart.clientWidth;
    if (this.plot && width > 100 && width !== this.plot.width)
      this.plot.setSize({ width, height: HEIGHT });
  }

  showTime() {
    if (!this.plot) return;
    const [min, max] = this.panel.zoom;
    const { time } = this.panel.clock;
    this.cursor.hidden = time < min || time > max;
    // By the zoom and not by the plot's scale, which follows a little later.
    const x = ((time - min) / (max - min)) * this.plot.over.clientWidth;
    this.cursor.style.transform = `translateX(${x.toFixed(1)}px)`;
  }

  /**
   * The values at an entry of the series. In a thinned run entries 2 b and 2 b + 1 are the least
   * and the greatest value of bucket b, in the order in which they came: no one value, but a range.
   */
  showValues(index) {
    const first = this.panel.bucket > 1 ? index - (index % 2) : index;
    for (const { value, values } of this.curves) {
      const [one, other] = [values[first], values[first + 1]];
      const isRange = this.panel.bucket > 1 && Number.isFinite(other) && one !== other;
      const [least, greatest] = isRange && other < one ? [other, one] : [one, other];
      const text = isRange ? `${number(least, 3)} … ${number(greatest, 3)}` : number(least, 3);
      if (value.textContent !== text) value.textContent = text;
    }
  }

  /** What uPlot draws: its data by curve, and the limits where their lines were drawn. */
  drawn() {
    const { data, series } = this.plot;
    return {
      group: this.group.name,
      times: Array.from(data[0]),
      curves: series
        .slice(1)
        .map(({ label, show }, i) => ({ name: label, shown: show, values: Array.from(data[i + 1]) })),
      limits: this.limitLines,
    };
  }
}
