// SPDX-License-Identifier: Apache-2.0
// How the run goes: the figures of the summary as they are now.

import { element, number } from '../app/dom.js';
import { section } from './fields.js';

const ROWS = [
  ['Real time', (s) => `${s.real_time_factor.toFixed(2)} ×`],
  ['Step, median', (s) => `${s.step_us.p50.toFixed(0)} µs`],
  ['Step, p99', (s) => `${s.step_us.p99.toFixed(0)} µs`],
  ['Step, longest', (s) => `${s.step_us.max.toFixed(0)} µs`],
  ['Rows, contacts', (s) => `${s.rows}, ${s.contacts}`],
  ['Iterations', (s) => s.iterations],
  ['Certificate', (s) => (s.certified ? `yes, ${number(s.stationarity, 2)}` : 'no')],
  ['Realised', (s) => number(s.realised, 2)],
  ['Physics violation', (s) => `${number(s.physics_violation, 2)} N, N m`],
  ['Penetration', (s) => `${(1000 * s.penetration).toFixed(2)} mm`],
  ['Energy', (s) => `${s.energy.toFixed(1)} J`],
  ['Fallen', (s) => s.fallen.join(', ') || 'none'],
  ['At their bounds', (s) => s.saturated.join(', ') || 'none'],
  ['Pages', (s) => s.pages],
];

export function figures(link) {
  const cells = ROWS.map(() => element('dd'));
  const told = element('ul', { class: 'told' });
  link.on('status', (status) => {
    ROWS.forEach(([, text], i) => (cells[i].textContent = text(status)));
    told.replaceChildren(...status.told.map((text) => element('li', {}, text)));
  });
  return section(
    'Figures',
    true,
    element(
      'dl',
      { class: 'facts live-figures' },
      ...ROWS.flatMap(([name], i) => [element('dt', {}, name), cells[i]]),
    ),
    told,
  );
}
