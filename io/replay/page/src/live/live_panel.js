// SPDX-License-Identifier: Apache-2.0
// What a live run has in place of plots: figures, goals, states, the world, and joints.

import { element } from '../app/dom.js';
import { withRun } from '../app/own_text.js';
import { save } from '../app/save.js';
import { packRun } from '../data/pack.js';
import { numberField, section, switchField } from './fields.js';
import { figures } from './figures.js';
import { goalList } from './goal_list.js';
import { states } from './keyframes.js';
import { Recorder } from './recorder.js';

function world(link, run) {
  const axes = ['x', 'y', 'z'];
  const gravity = axes.map((axis, i) =>
    numberField(`gravity ${axis}`, 'm/s²', (value) => {
      const acceleration = [...link.status.gravity];
      acceleration[i] = value;
      link.tell({ gravity: { acceleration } });
    }),
  );
  const effects = run.live.effects.map((name) => [
    name,
    switchField(name.replaceAll('_', ' '), (on) => link.tell({ effect: { effect: name, on } })),
  ]);
  link.on('status', (status) => {
    gravity.forEach((field, i) => field.show(status.gravity[i]));
    for (const [name, field] of effects) field.show(!status.effects_off.includes(name));
  });
  return section(
    'Gravity and effects',
    false,
    element('div', { class: 'fields' }, ...gravity.map(({ node }) => node)),
    element('div', { class: 'switches' }, ...effects.map(([, { node }]) => node)),
  );
}

/** A slider each; joints without a range go once around, or a metre each way. */
function joints(link, run) {
  const rows = run.live.joints.map(({ name, unit, lower, upper }) => {
    const far = unit === 'rad' ? Math.PI : 1;
    const slider = element('input', {
      type: 'range',
      min: lower ?? -far,
      max: upper ?? far,
      step: 'any',
      'aria-label': `${name} in ${unit}`,
      oninput: () => link.tell({ joint: { joint: name, position: slider.valueAsNumber } }),
    });
    const value = element('output', { class: 'quiet' });
    return { slider, value, unit, node: element('label', { class: 'joint-slider' }, element('span', { title: name }, name), slider, value) };
  });
  const hint = element('p', { class: 'quiet' });
  link.on('status', (status) => {
    const canMove = status.paused || status.targets.length > 0;
    hint.textContent = status.paused
      ? 'The run is paused: joints are put where the sliders are.'
      : canMove
        ? 'Sought is where the sliders are.'
        : 'Pause the run to move its joints.';
    rows.forEach(({ slider, value, unit }, i) => {
      slider.disabled = !canMove;
      const at = status.paused || !canMove ? status.joints[i] : status.targets[i];
      if (document.activeElement !== slider) slider.value = at;
      value.textContent = `${status.joints[i].toFixed(3)} ${unit}`;
    });
  });
  return section('Joints', false, hint, ...rows.map(({ node }) => node));
}

/** What one may do. */
function hint({ live, header }) {
  if (live.passive) return 'Live. Push a link.';
  return header.goals.some(({ name }) => name.startsWith('plan')) ? 'Live. Drag a target or a link.' : 'Live. Drag a link.';
}

/** What this page has seen, as a page that replays it. */
function saveReplay(run, recorder, pageText) {
  const button = element(
    'button',
    {
      type: 'button',
      class: 'wide',
      disabled: true,
      title: 'What this page has seen of the run, as a page that replays it',
      onclick: async () => {
        button.disabled = true;
        const { header, arrays } = recorder.contents();
        const page = withRun(pageText, await packRun(header, arrays));
        save(`${run.header.model || 'run'}.html`, new Blob([page], { type: 'text/html' }));
        button.disabled = false;
      },
    },
    'Save replay page',
  );
  recorder.onFirst(() => (button.disabled = false));
  return button;
}

/** The model's files as they are now. */
const reload = (link) =>
  element(
    'button',
    {
      type: 'button',
      class: 'wide',
      title: 'Reads the model and its goals again and begins from their start; what is wrong with them is told',
      onclick: () => link.tell({ reload: {} }),
    },
    'Reload model',
  );

/** `pageText`: this page without a run. */
export function livePanel(host, link, run, settings, pageText) {
  const state = element('p', { class: 'live-state', role: 'status', id: 'live-state' });
  const write = element(
    'button',
    { type: 'button', class: 'wide', hidden: true, onclick: () => link.tell({ write: true }) },
    'Take over',
  );
  const show = () => {
    const lost = link.wasConnected && !link.connected;
    if (lost) state.textContent = 'The run has ended or cannot be reached. Trying again.';
    else if (!link.connected) state.textContent = 'Connecting.';
    else if (!link.writes) state.textContent = 'Live. Another page has the mouse; this one watches.';
    else state.textContent = hint(run);
    state.classList.toggle('lost', lost);
    write.hidden = !link.connected || link.writes;
  };
  let wait = null;
  link.on('connected', show);
  link.on('writes', show);
  link.on('refused', (reason) => {
    state.textContent = reason;
    clearTimeout(wait);
    wait = setTimeout(show, 4000);
  });
  show();
  host.append(
    element(
      'div',
      { class: 'scroll live-panel' },
      state,
      write,
      goalList(link, run, settings),
      saveReplay(run, new Recorder(run, link), pageText),
      reload(link),
      states(link, run),
      figures(link),
      world(link, run),
      joints(link, run),
    ),
  );
}
