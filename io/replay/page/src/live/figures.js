// SPDX-License-Identifier: Apache-2.0
// How the run goes: the figures of the summary as they are now, and as they were in the last minute.

import { element, number } from '../app/dom.js';
import { section } from './fields.js';
import { Sparkline } from './sparkline.js';

const fixedTo = (decimals) => (value) => value.toFixed(decimals);
const digits = (count) => (value) => number(value, count);

// Name, unit, value in a status, how it is written.
const NUMBERS = [
  ['Real time', '×', (s) => s.real_time_factor, fixedTo(2)],
  ['Step, median', 'µs', (s) => s.step_us.p50, fixedTo(0)],
  ['Step, p99', 'µs', (s) => s.step_us.p99, fixedTo(0)],
  ['Step, longest', 'µs', (s) => s.step_us.max, fixedTo(0)],
  ['Rows', '', (s) => s.rows, String],
  ['Contacts', '', (s) => s.contacts, String],
  ['Iterations', '', (s) => s.iterations, String],
  ['Stationarity', '', (s) => s.stationarity, digits(2)],
  ['Realised', '', (s) => s.realised, digits(2)],
  ['Physics violation', 'N, N m', (s) => s.physics_violation, digits(2)],
  ['Penetration', 'mm', (s) => 1000 * s.penetration, fixedTo(3)],
  ['Energy', 'J', (s) => s.energy, fixedTo(1)],
];
const TEXTS = [
  ['Certificate', (s) => (s.certified ? 'yes' : 'no')],
  ['Fallen', (s) => s.fallen.join(', ') || 'none'],
  ['Controls at bounds', (s) => s.saturated.join(', ') || 'none'],
  ['Joints at limits', (s) => s.at_limits.join(', ') || 'none'],
  ['Pages', (s) => String(s.pages)],
];
// Errors are shown in units in which they are no long numbers.
const SHOWN = { m: ['mm', 1000, fixedTo(1)] };

/** A number with its name, unit and curve. */
function row(name, unit, text) {
  const line = new Sparkline();
  const cell = element('dd');
  return {
    nodes: [element('dt', { title: name }, name), line.canvas, cell],
    show: (value) => {
      line.add(value, unit);
      cell.textContent = Number.isFinite(value) ? `${text(value)} ${unit}`.trim() : '–';
    },
  };
}

/** How far each goal is from what it wants; the list follows the goals. */
function goalErrors(link, host) {
  const rows = new Map();
  link.on('status', ({ errors }) => {
    for (const { name, unit, value } of errors) {
      const [shown, scale, text] = SHOWN[unit] ?? [unit, 1, digits(3)];
      if (!rows.has(name)) {
        const made = row(name, shown, text);
        rows.set(name, made);
        host.append(...made.nodes);
      }
      rows.get(name).show(scale * value);
    }
    for (const [name, made] of rows)
      if (!errors.some((error) => error.name === name)) {
        for (const node of made.nodes) node.remove();
        rows.delete(name);
      }
  });
}

export function figures(link) {
  const numbers = NUMBERS.map(([name, unit, , text]) => row(name, unit, text));
  const texts = TEXTS.map(([name]) => [element('dt', {}, name), element('dd', { class: 'wide-cell' })]);
  const told = element('ul', { class: 'told' });
  link.on('status', (status) => {
    NUMBERS.forEach(([, , valueOf], i) => numbers[i].show(valueOf(status)));
    TEXTS.forEach(([, text], i) => (texts[i][1].textContent = text(status)));
    told.replaceChildren(...status.told.map((text) => element('li', {}, text)));
  });
  const list = (...nodes) => element('dl', { class: 'live-figures' }, ...nodes);
  const errors = list();
  goalErrors(link, errors);
  return section(
    'Figures',
    true,
    errors,
    list(...numbers.flatMap(({ nodes }) => nodes), ...texts.flat()),
    told,
  );
}
