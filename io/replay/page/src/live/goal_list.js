// SPDX-License-Identifier: Apache-2.0
// The goals in force, with their switches and numbers.

import { element } from '../app/dom.js';
import { numberField, section, switchField } from './fields.js';
import { goalsText, whyNot } from './goals_text.js';
import { save } from '../app/save.js';

// Keys of a goal, with units; a weight's is of the goal's kind.
const NUMBERS = [
  ['weight', null],
  ['stiffness', '1/s²'],
  ['damping', '1/s'],
  ['rate', '1/s'],
];

function row(link, goal) {
  const set = (fields) => link.tell({ goal: { goal: goal.name, ...fields } });
  const law = goal.duration ? `, in ${goal.duration} s` : '';
  const title = goal.link ? `${goal.name}: ${goal.link}${law}` : goal.name;
  const toggle = switchField(title, (on) => set({ on }));
  const why = element('span', { class: 'quiet' });
  toggle.node.append(why);
  const fields = NUMBERS.filter(([key]) => key in goal).map(([key, unit]) => [
    key,
    numberField(key, unit ?? goal.weight_unit, (value) => set({ [key]: value })),
  ]);
  return {
    node: element(
      'div',
      { class: 'live-goal', 'data-goal': goal.name },
      toggle.node,
      element('div', { class: 'fields' }, ...fields.map(([, field]) => field.node)),
    ),
    show: (now, time) => {
      // One that has ended or is still to come is not in force, and no switch makes it so.
      toggle.show(now.acts, now.on && !now.acts);
      why.textContent = now.on && !now.acts ? `, ${whyNot(now, time)}` : '';
      for (const [key, field] of fields) field.show(now[key]);
    },
  };
}

/** By which law a point that is dragged comes to the mouse. */
function dragLaw(settings) {
  const seconds = element('input', {
    type: 'number',
    min: 0.01,
    max: 100,
    step: 0.1,
    value: 0.5,
    'aria-label': 'Duration of a minimum-jerk line in s',
  });
  const law = element(
    'select',
    { 'aria-label': 'A dragged point comes by' },
    element('option', { value: 'spring' }, 'spring-damper'),
    element('option', { value: 'jerk' }, 'minimum jerk'),
  );
  const time = element('span', { class: 'jerk-time' }, ' in ', seconds, ' s');
  const set = () => {
    time.hidden = law.value !== 'jerk';
    const duration = Math.min(100, Math.max(0.01, seconds.valueAsNumber || 0.5));
    settings.set('jerkTime', time.hidden ? 0 : duration);
  };
  law.addEventListener('change', set);
  seconds.addEventListener('change', set);
  set();
  return element('div', { class: 'drag-law' }, 'A dragged point comes by ', law, time);
}

export function goalList(link, run, settings) {
  const list = element('div');
  const none = element('p', { class: 'quiet' }, run.live.passive ? 'Nothing drives this run: links can be pushed.' : '');
  let rows = new Map();
  let shape = '';
  link.on('status', ({ goals, time }) => {
    const next = JSON.stringify(goals.map((goal) => [goal.name, goal.link, goal.duration]));
    if (next !== shape) {
      shape = next;
      rows = new Map(goals.map((goal) => [goal.name, row(link, goal)]));
      list.replaceChildren(...[...rows.values()].map(({ node }) => node));
    }
    for (const goal of goals) rows.get(goal.name).show(goal, time);
  });
  return section(
    'Goals',
    true,
    none,
    run.live.passive ? null : dragLaw(settings),
    list,
    element(
      'button',
      {
        type: 'button',
        class: 'wide',
        disabled: run.live.passive,
        onclick: () =>
          save('goals.yaml', new Blob([goalsText(link.status, run)], { type: 'text/yaml' })),
      },
      'Save as goals.yaml',
    ),
  );
}
