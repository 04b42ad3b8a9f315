// SPDX-License-Identifier: Apache-2.0
// Pause, step, back, reset, how fast; what a press on a link does; whether the run is still there.

import { element, icon, iconButton } from '../app/dom.js';
import { FACTORS } from './live_clock.js';

const ACTIONS = [
  ['drag', 'Drag', 'A press on a link drags its point'],
  ['push', 'Push', 'A press on a link pushes it (shift)'],
  ['turn', 'Turn', 'A press on a link turns it (ctrl)'],
];

export function liveTransport(host, link, clock, settings) {
  const play = iconButton('pause', 'Pause (space)', () => clock.toggle(), { class: 'tool primary' });
  const now = element('output', { class: 'now', id: 'live-time' });
  const rate = element('span', { class: 'frame-number' });
  const factor = element(
    'select',
    {
      title: 'Simulated over real time ([ and ])',
      'aria-label': 'Time factor',
      onchange: () => clock.setSpeed(Number(factor.value)),
    },
    ...FACTORS.map((f) => element('option', { value: f }, `${f}×`)),
  );
  const actions = ACTIONS.map(([action, name, title]) =>
    element('button', { type: 'button', title, onclick: () => settings.set('action', action) }, name),
  );
  const showAction = () =>
    actions.forEach((button, i) =>
      button.setAttribute('aria-pressed', ACTIONS[i][0] === settings.get('action')),
    );
  settings.on('action', showAction);
  showAction();
  const pins = element('input', {
    type: 'checkbox',
    onchange: () => settings.set('pins', pins.checked),
  });
  const step = iconButton('next', 'One step (→)', () => link.tell({ advance: { count: 1 } }));
  const controls = [
    iconButton('first', 'To the start (home)', () => link.tell({ reset: {} })),
    iconButton('back', 'One second back (←)', () => link.tell({ back: { seconds: 1 } })),
    play,
    step,
  ];
  host.append(
    element('div', { class: 'buttons' }, ...controls),
    element('div', { class: 'clock' }, now, element('span', { class: 'of' }, ' s'), rate),
    element('div', { class: 'buttons' }, factor),
    element(
      'div',
      { class: 'segments', role: 'group', 'aria-label': 'What a press on a link does' },
      ...actions,
    ),
    element(
      'label',
      { class: 'labelled', title: 'A dragged point’s goal stays when it is let go' },
      pins,
      'Pin',
    ),
  );

  const show = () => (now.textContent = clock.time.toFixed(2));
  const showPlaying = () => {
    play.replaceChildren(icon(clock.playing ? 'pause' : 'play'));
    play.title = clock.playing ? 'Pause (space)' : 'Go on (space)';
    play.setAttribute('aria-label', play.title);
    step.disabled = clock.playing;
  };
  clock.on('time', show);
  clock.on('playing', showPlaying);
  link.on('status', (status) => {
    rate.textContent = status.paused
      ? 'paused'
      : `${status.real_time_factor.toFixed(2)} × real time`;
    if (document.activeElement !== factor) factor.value = status.factor;
  });
  factor.value = 1;
  show();
  showPlaying();
}
