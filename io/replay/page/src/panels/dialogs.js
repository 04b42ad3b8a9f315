// SPDX-License-Identifier: Apache-2.0
// What one can look up: the run, the keys, the licences.

import { byId, element } from '../app/dom.js';

const KEYS = [
  ['space', 'play or pause'],
  ['← →', 'one frame back or on; with shift ten'],
  ['home end', 'to the start, to the end'],
  ['[ ]', 'slower, faster'],
  ['l', 'loop'],
  ['f', 'follow the selected link, else the centre of mass'],
  ['a', 'frame all'],
  ['shift F S T', 'look from the front, the side, the top'],
  ['c', 'visual shapes, collision shapes, both'],
  ['g', 'contact forces on or off'],
  ['1 … 9', 'show or hide a group of plots'],
  ['m', 'limits of all curves'],
  ['z', 'plots over all time'],
  ['/', 'search a link'],
  ['k', 'links on or off'],
  ['p', 'plots on or off'],
  ['t', 'dark or light'],
  ['i', 'about this run'],
  ['?', 'this help'],
  ['esc', 'close, or select nothing'],
];
const POINTER = [
  ['drag in the view', 'turns the camera; the right button moves it, the wheel zooms'],
  ['click a link', 'selects it: its numbers, its frame, its path, its curves'],
  ['double-click a link', 'brings it to the middle'],
  ['click or drag in a plot', 'goes to that time'],
  ['wheel in a plot', 'zooms in time; so does a drag with shift'],
  ['double-click a plot', 'shows all time'],
  ['click a curve’s name', 'hides or shows it; a double-click shows it alone'],
];

const LIVE_KEYS = [
  ['space', 'pause or go on'],
  ['→', 'one step of a paused run'],
  ['←', 'one second back'],
  ['home', 'to the start'],
  ['[ ]', 'slower, faster'],
  ['1 … 9', 'to a stored state; with shift the state is stored'],
];
const LIVE_POINTER = [
  ['drag a link', 'pulls the point that you hold'],
  ['drag with shift', 'pushes the link; with ctrl it turns it'],
  ['drag elsewhere', 'turns the camera; the right button moves it, the wheel zooms'],
];
const NOT_LIVE = ['space', '← →', 'home end', '[ ]', 'l', '1 … 9', 'm', 'z'];

const table = (rows) =>
  element(
    'dl',
    { class: 'keys' },
    ...rows.flatMap(([key, text]) => [element('dt', {}, key), element('dd', {}, text)]),
  );

export function dialogs(run) {
  const { header } = run;
  byId('help-body').append(
    element('h3', {}, 'Keys'),
    table(run.live ? [...LIVE_KEYS, ...KEYS.filter(([key]) => !NOT_LIVE.includes(key))] : KEYS),
    element('h3', {}, 'Pointer'),
    table(run.live ? [...LIVE_POINTER, ...POINTER.slice(1, 3)] : POINTER),
  );
  byId('info-body').append(
    element(
      'dl',
      { class: 'facts' },
      ...[
        ...header.facts,
        ...(run.live ? [] : [['frames', `${run.frames} over ${run.end.toFixed(3)} s`]]),
        ['time step', `${header.timestep} s`],
        ['written by', header.generator],
        ['command', header.command],
      ].flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, value)]),
    ),
    ...(header.warnings.length > 0
      ? [
          element('h3', {}, 'Warnings'),
          element('ul', {}, ...header.warnings.map((text) => element('li', {}, text))),
        ]
      : []),
  );
  for (const dialog of document.querySelectorAll('dialog'))
    dialog.addEventListener('click', (event) => {
      // The backdrop is the dialog itself.
      if (event.target === dialog || event.target.closest('.close')) dialog.close();
    });
}

export function toggleDialog(id) {
  const dialog = byId(id);
  if (dialog.open) dialog.close();
  else dialog.showModal();
}
