// SPDX-License-Identifier: Apache-2.0

// JSON that a diff can be read in: lists of numbers and small objects on one line, numbers as the
// shortest decimals that give the same double again.

const kWidth = 100;

const isFlat = (value) =>
  value === null || typeof value !== 'object' || (Array.isArray(value) && value.every((x) => typeof x !== 'object'));

function compact(value) {
  if (Array.isArray(value)) return `[${value.map(compact).join(', ')}]`;
  if (value === null || typeof value !== 'object') {
    if (typeof value === 'number' && !Number.isFinite(value)) throw new Error(`${value} in a log`);
    return JSON.stringify(value);
  }
  const entries = Object.entries(value).filter(([, x]) => x !== undefined);
  return `{${entries.map(([key, x]) => `${JSON.stringify(key)}: ${compact(x)}`).join(', ')}}`;
}

export function jsonText(value, indent = '') {
  if (isFlat(value)) return compact(value);
  const whole = compact(value);
  if (!Array.isArray(value) && Object.values(value).every(isFlat) && whole.length < kWidth) return whole;
  const inner = `${indent} `;
  const items = Array.isArray(value)
    ? value.map((x) => inner + jsonText(x, inner))
    : Object.entries(value)
        .filter(([, x]) => x !== undefined)
        .map(([key, x]) => `${inner}${JSON.stringify(key)}: ${jsonText(x, inner)}`);
  const [open, close] = Array.isArray(value) ? '[]' : '{}';
  return `${open}\n${items.join(',\n')}\n${indent}${close}`;
}
