// SPDX-License-Identifier: Apache-2.0
// Play, pause, step, scrub, speed, loop.

import { SPEEDS } from '../app/clock.js';
import { element, icon, iconButton } from '../app/dom.js';

const speedName = (speed) => (speed < 1 ? `1/${1 / speed}×` : `${speed}×`);

export function transport(host, run, clock) {
  const play = iconButton('play', 'Play (space)', () => clock.toggle(), { class: 'tool primary' });
  const slider = element('input', {
    type: 'range',
    class: 'timeline',
    min: run.start,
    max: run.end,
    step: 'any',
    'aria-label': 'Time',
    oninput: () => clock.seek(slider.valueAsNumber),
  });
  const now = element('output', { class: 'now' });
  const frame = element('span', { class: 'frame-number' });
  const speed = element(
    'select',
    {
      title: 'Speed ([ and ])',
      'aria-label': 'Speed',
      onchange: () => clock.setSpeed(Number(speed.value)),
    },
    ...SPEEDS.map((s) => element('option', { value: s }, speedName(s))),
  );
  const loop = iconButton('loop', 'Loop (l)', () => clock.setLoop(!clock.loop), {
    'aria-pressed': 'false',
  });
  host.append(
    element(
      'div',
      { class: 'buttons' },
      iconButton('first', 'To the start (home)', () => clock.seek(run.start)),
      iconButton('back', 'One frame back (←)', () => clock.step(-1)),
      play,
      iconButton('next', 'One frame on (→)', () => clock.step(1)),
      iconButton('last', 'To the end (end)', () => clock.seek(run.end)),
    ),
    slider,
    element(
      'div',
      { class: 'clock' },
      now,
      element('span', { class: 'of' }, ` / ${run.end.toFixed(2)} s`),
      frame,
    ),
    element('div', { class: 'buttons' }, speed, loop),
  );

  const showTime = () => {
    slider.value = clock.time;
    slider.setAttribute('aria-valuetext', `${clock.time.toFixed(3)} seconds`);
    const span = run.end - run.start || 1;
    slider.style.setProperty('--done', `${(100 * (clock.time - run.start)) / span}%`);
    now.textContent = clock.time.toFixed(3);
    frame.textContent = `frame ${run.nearest(clock.time) + 1} of ${run.frames}`;
  };
  const showPlaying = () => {
    play.replaceChildren(icon(clock.playing ? 'pause' : 'play'));
    play.title = clock.playing ? 'Pause (space)' : 'Play (space)';
    play.setAttribute('aria-label', play.title);
  };
  clock.on('time', showTime);
  clock.on('playing', showPlaying);
  clock.on('speed', () => (speed.value = clock.speed));
  clock.on('loop', () => loop.setAttribute('aria-pressed', clock.loop));
  speed.value = clock.speed;
  showTime();
}
