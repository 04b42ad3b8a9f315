// SPDX-License-Identifier: Apache-2.0
// Numbers that are typed and shown: what is being typed is left alone.

import { element } from '../app/dom.js';

/** A number with its name and unit; `change(value)` is called when a new one is complete. */
export function numberField(name, unit, change) {
  const input = element('input', {
    type: 'number',
    step: 'any',
    'aria-label': unit ? `${name} in ${unit}` : name,
    onchange: () => Number.isFinite(input.valueAsNumber) && change(input.valueAsNumber),
  });
  const node = element(
    'label',
    { class: 'field' },
    element('span', {}, name),
    input,
    element('span', { class: 'unit' }, unit),
  );
  return {
    node,
    show: (value) => {
      if (document.activeElement !== input) input.value = Number(value.toPrecision(6));
    },
  };
}

/** A switch with its name. */
export function switchField(name, change) {
  const box = element('input', { type: 'checkbox', onchange: () => change(box.checked) });
  return {
    node: element('label', { class: 'switch' }, box, name),
    show: (on, isFixed = false) => {
      box.checked = on;
      box.disabled = isFixed;
    },
  };
}

/** A titled part of the panel that opens and closes. */
export function section(title, open, ...children) {
  return element(
    'details',
    { class: 'live-section', open },
    element('summary', {}, title),
    ...children,
  );
}
