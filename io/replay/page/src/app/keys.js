// SPDX-License-Identifier: Apache-2.0
// Every key of the page. Keys typed into a field, and those a focused widget needs, are left alone.

import { byId } from './dom.js';
import { keyframe } from '../live/keyframes.js';
import { toggleDialog } from '../panels/dialogs.js';

/**
 * What the pointer has pressed gives the keyboard back, so that the space bar plays and arrows step
 * after a click on a button or a slider, as before it.
 */
function releaseAfterPointer() {
  document.addEventListener('click', (event) => {
    if (event.detail > 0 && !event.target.closest('dialog'))
      event.target.closest('button, [type=checkbox], [type=range]')?.blur();
  });
  document.addEventListener('change', (event) => {
    if (event.target.matches('select')) event.target.blur();
  });
}

export function listenToKeys({ clock, link, settings, selection, layout, plots, stage }) {
  const actions = {
    ' ': () => clock.toggle(),
    ArrowLeft: (event) => clock.step(event.shiftKey ? -10 : -1),
    ArrowRight: (event) => clock.step(event.shiftKey ? 10 : 1),
    Home: () => clock.toStart(),
    End: () => clock.toEnd(),
    '[': () => clock.faster(-1),
    ']': () => clock.faster(1),
    l: () => clock.setLoop(!clock.loop),
    f: () => settings.set('follow', settings.get('follow') ? null : (selection.name ?? 'com')),
    a: () => stage?.frameAll(),
    F: () => stage?.frameAll('front'),
    S: () => stage?.frameAll('side'),
    T: () => stage?.frameAll('top'),
    c: () => settings.nextMode(),
    g: () => settings.set('forces', !settings.get('forces')),
    m: () => settings.set('limits', !settings.get('limits')),
    z: () => plots?.setZoom(plots.full),
    k: () => layout.toggle('links'),
    p: () => layout.toggle('plots'),
    t: () => settings.toggleTheme(),
    i: () => toggleDialog('info'),
    '?': () => toggleDialog('help'),
    '/': () => {
      layout.open('links', true);
      byId('search').focus();
    },
    Escape: () => selection.select(null),
  };
  releaseAfterPointer();
  for (let digit = 1; digit <= 9; ++digit)
    actions[digit] = ({ shiftKey }) =>
      link ? keyframe(link, digit, shiftKey) : plots?.toggle(digit - 1);

  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const { target } = event;
    const open = document.querySelector('dialog[open]');
    if (open && !['?', 'i'].includes(event.key)) return;
    if (target.matches('input:not([type=range], [type=checkbox]), textarea')) return;
    // The space bar presses a focused button, arrows move in a list.
    if (event.key === ' ' && target.matches('button, summary, [type=checkbox], select')) return;
    if (target.matches('select') && !['[', ']', '?'].includes(event.key)) return;
    if (target.matches('[type=range]:not(.timeline)') && /^(Arrow|Home|End)/.test(event.key))
      return;
    // With shift a digit's key is another character, and which one is the keyboard's affair.
    const digit = link && event.shiftKey ? event.code.match(/^Digit([1-9])$/)?.[1] : null;
    const action = actions[digit ?? event.key];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
}
