// SPDX-License-Identifier: Apache-2.0
// States to go to: those of the robot's SRDF, and nine that are stored while the run goes on.

import { element } from '../app/dom.js';
import { section } from './fields.js';

export const SLOTS = [1, 2, 3, 4, 5, 6, 7, 8, 9];

/** Stores with shift, or goes there; what is not stored is not gone to. */
export function keyframe(link, slot, stores) {
  if (stores) return link.tell({ store: { slot } });
  return link.status?.stored.includes(slot) ? link.tell({ recall: { slot } }) : null;
}

const button = (text, title, onclick, more = {}) =>
  element('button', { type: 'button', title, onclick, ...more }, text);

/** Buttons in a row, called `label`. */
const row = (label, buttons) =>
  element('div', { class: 'segments wrap', role: 'group', 'aria-label': label }, ...buttons);

export function states(link, run) {
  const named = run.live.states.map((name) =>
    button(name, `To the state ${name} of the SRDF`, () => link.tell({ state: { state: name } })),
  );
  const store = element('input', { type: 'checkbox', onchange: () => show() });
  const slots = SLOTS.map((slot) =>
    button(
      slot,
      `To what is stored in ${slot} (${slot}); stores it with shift`,
      (event) => keyframe(link, slot, event.shiftKey || store.checked),
      { 'aria-label': `Keyframe ${slot}` },
    ),
  );
  const show = () =>
    SLOTS.forEach((slot, i) => {
      const isStored = link.status?.stored.includes(slot) ?? false;
      slots[i].setAttribute('aria-pressed', isStored);
      slots[i].disabled = !isStored && !store.checked;
    });
  link.on('status', show);
  show();
  return section(
    'States',
    true,
    ...(named.length > 0 ? [row('States of the SRDF', named)] : []),
    row('Keyframes', slots),
    element(
      'label',
      { class: 'labelled', title: 'A press on a number stores the state there (shift)' },
      store,
      'Store',
    ),
  );
}
