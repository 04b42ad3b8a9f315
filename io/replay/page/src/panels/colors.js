// SPDX-License-Identifier: Apache-2.0
// Colours of curves: distinct for the first ten, then by the golden angle.

const FIRST = {
  light: [
    '#1f77b4',
    '#d9620b',
    '#2a9134',
    '#c62f3b',
    '#8256b8',
    '#8c564b',
    '#c94fa0',
    '#5d6772',
    '#8f8a12',
    '#128ea1',
  ],
  dark: [
    '#5aa9e6',
    '#f59a4b',
    '#63c66b',
    '#f0696f',
    '#b394e8',
    '#c79b8f',
    '#ee8fcb',
    '#aab4bf',
    '#cfca4c',
    '#4fcbdc',
  ],
};

export function curveColor(index, theme) {
  if (index < FIRST[theme].length) return FIRST[theme][index];
  const hue = (index * 137.508 + 20) % 360;
  const light = theme === 'dark' ? 62 + 8 * (index % 3) : 36 + 6 * (index % 3);
  return `hsl(${hue.toFixed(1)}deg 62% ${light}%)`;
}
