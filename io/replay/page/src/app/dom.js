// SPDX-License-Identifier: Apache-2.0
// Making elements and icons.

/**
 * element('button', {class: 'tool', title: 'Play', onclick: f}, 'text', child). Names that begin
 * with "on" are listeners, the others attributes; false and null leave an attribute out.
 */
export function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, '');
    else if (value !== false && value != null) node.setAttribute(name, value);
  }
  node.append(...children.filter((child) => child != null));
  return node;
}

export const byId = (id) => document.getElementById(id);

// Paths on a grid of 16 × 16; those in FILLED are filled, the others stroked.
const ICONS = {
  play: 'M4.5 2.5v11l9-5.5z',
  pause: 'M4 2.5h3v11H4zM9 2.5h3v11H9z',
  first: 'M3 2.5h2v11H3zM13 2.5v11L5.5 8z',
  last: 'M11 2.5h2v11h-2zM3 2.5v11L10.5 8z',
  back: 'M9.5 3.5L5 8l4.5 4.5',
  next: 'M6.5 3.5L11 8l-4.5 4.5',
  loop: 'M3 8V6.5A2.5 2.5 0 0 1 5.5 4H12M10 2l2 2-2 2M13 8v1.5A2.5 2.5 0 0 1 10.5 12H4M6 10l-2 2 2 2',
  tree: 'M3 2v9.5h4M3 5.5h4M9 3.5h4.5v4H9zM9 9.5h4.5v4H9z',
  plots: 'M2.5 2v11.5H14M4.5 10.5l3-4 2.5 2 3.5-5',
  eye: 'M1.5 8S4 3.5 8 3.5 14.5 8 14.5 8 12 12.5 8 12.5 1.5 8 1.5 8zM8 6a2 2 0 1 0 0 4 2 2 0 0 0 0-4z',
  info: 'M8 1.5a6.5 6.5 0 1 0 0 13 6.5 6.5 0 0 0 0-13zM8 7v4.5M8 4.5v.5',
  help: 'M8 1.5a6.5 6.5 0 1 0 0 13 6.5 6.5 0 0 0 0-13zM6 6.3a2 2 0 1 1 2.8 1.9c-.5.3-.8.6-.8 1.3M8 11.5v.3',
  sun: 'M8 5a3 3 0 1 0 0 6 3 3 0 0 0 0-6zM8 1v1.5M8 13.5V15M1 8h1.5M13.5 8H15M3 3l1 1M12 12l1 1M13 3l-1 1M4 12l-1 1',
  moon: 'M13.5 9.5A6 6 0 0 1 6.5 2.5a6 6 0 1 0 7 7z',
  frame: 'M2 5V2h3M11 2h3v3M14 11v3h-3M5 14H2v-3M6 6h4v4H6z',
  follow: 'M8 1v3M8 12v3M1 8h3M12 8h3M8 4.5a3.5 3.5 0 1 0 0 7 3.5 3.5 0 0 0 0-7z',
  close: 'M3.5 3.5l9 9M12.5 3.5l-9 9',
  chevron: 'M6 4l4 4-4 4',
  limits:
    'M1.5 4h2M5.5 4h2M9.5 4h2M13 4h1.5M1.5 12h2M5.5 12h2M9.5 12h2M13 12h1.5M2 9c3-4 5 3 8-1l4-1',
  picture: 'M2 4.5h3l1-1.5h4l1 1.5h3v8.5H2zM8 6.5a2.2 2.2 0 1 0 0 4.4 2.2 2.2 0 0 0 0-4.4z',
  video: 'M1.5 4h8.5v8H1.5zM10 7l4.5-2.5v7L10 9z',
  beside: 'M2 2.5h8v8H2zM6 6.5h8v8H6z',
  save: 'M8 2v8M4.5 7L8 10.5 11.5 7M2.5 13.5h11',
  reset: 'M2 8h12M5 5L2 8l3 3M11 5l3 3-3 3',
};
const FILLED = new Set(['play', 'pause', 'first', 'last']);

export function icon(name) {
  const space = 'http://www.w3.org/2000/svg';
  const svg = document.createElementNS(space, 'svg');
  svg.setAttribute('viewBox', '0 0 16 16');
  svg.setAttribute('aria-hidden', 'true');
  svg.setAttribute('class', FILLED.has(name) ? 'icon filled' : 'icon');
  const path = document.createElementNS(space, 'path');
  path.setAttribute('d', ICONS[name]);
  svg.append(path);
  return svg;
}

/** A button with an icon; `label` is its tooltip and its name for screen readers. */
export function iconButton(name, label, onclick, attributes = {}) {
  return element(
    'button',
    { type: 'button', class: 'tool', title: label, 'aria-label': label, onclick, ...attributes },
    icon(name),
  );
}

/** A number in at most `digits` significant digits, with a true minus. */
export function number(value, digits = 4) {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  const text =
    size !== 0 && (size < 1e-3 || size >= 1e5)
      ? Number(value.toPrecision(digits - 1)).toExponential()
      : String(Number(value.toPrecision(digits)));
  return text.replace('-', '−').replace('e-', 'e−').replace('e+', 'e');
}

/** A number with a fixed count of decimals, for columns that must not jump. */
export const fixed = (value, decimals) =>
  Number.isFinite(value) ? (value < 0 ? '−' : '\u2007') + Math.abs(value).toFixed(decimals) : '–';
