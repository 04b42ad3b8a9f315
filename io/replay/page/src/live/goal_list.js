// SPDX-License-Identifier: Apache-2.0
// The goals in force, with their switches and numbers.

import { element } from '../app/dom.js';
import { numberField, section, switchField } from './fields.js';
import { goalsText } from './goals_text.js';
import { save } from '../app/save.js';

const NUMBERS = [
  ['weight', ''],
  ['stiffness', '1/s²'],
  ['damping', '1/s'],
  ['rate', '1/s'],
];

function row(link, goal) {
  const set = (fields) => link.tell({ goal: { goal: goal.name, ...fields } });
  const toggle = switchField(goal.link ? `${goal.name}: ${goal.link}` : goal.name, (on) => set({ on }));
  const fields = NUMBERS.filter(([key]) => key in goal).map(([key, unit]) => [
    key,
    numberField(key, unit, (value) => set({ [key]: value })),
  ]);
  return {
    node: element(
      'div',
      { class: 'live-goal', 'data-goal': goal.name },
      toggle.node,
      element('div', { class: 'fields' }, ...fields.map(([, field]) => field.node)),
    ),
    show: (now) => {
      toggle.show(now.on);
      for (const [key, field] of fields) field.show(now[key]);
    },
  };
}

export function goalList(link, run) {
  const list = element('div');
  const none = element('p', { class: 'quiet' }, run.live.passive ? 'Nothing drives this run: links can be pushed.' : '');
  let rows = new Map();
  let shape = '';
  link.on('status', ({ goals }) => {
    const next = JSON.stringify(goals.map((goal) => [goal.name, goal.link]));
    if (next !== shape) {
      shape = next;
      rows = new Map(goals.map((goal) => [goal.name, row(link, goal)]));
      list.replaceChildren(...[...rows.values()].map(({ node }) => node));
    }
    for (const goal of goals) rows.get(goal.name).show(goal);
  });
  return section(
    'Goals',
    true,
    none,
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
