// SPDX-License-Identifier: Apache-2.0
// What lies over the view: what is shown, from where, following what; and which marks.

import { MARKS } from '../app/settings.js';
import { byId, element, icon, iconButton, number } from '../app/dom.js';
import { savePicture, Video } from '../app/save.js';
import { CONTACT_COLOR } from '../view/contacts.js';
import { COLORS } from '../view/marks.js';

const MODE_NAMES = [
  ['visual', 'Visual', 'Visual shapes'],
  ['collision', 'Collision', 'Collision shapes'],
  ['both', 'Both', 'Both, seen through'],
];
const SWATCHES = {
  forces: CONTACT_COLOR,
  contacts: CONTACT_COLOR,
  com: COLORS.com,
  cop: COLORS.cop,
  goals: COLORS.goal,
  axes: COLORS.axes[0],
  path: COLORS.path,
};
const SWATCH_CLASS = {
  forces: 'arrow',
  contacts: 'dot',
  com: 'ball',
  cop: 'dot',
  goals: 'ring',
  axes: 'axes',
  path: 'line',
};

export function toolbar(host, run, stage, settings, selection) {
  const modes = MODE_NAMES.map(([mode, name, title]) =>
    element(
      'button',
      {
        type: 'button',
        title: `${title} (c)`,
        onclick: () => settings.set('mode', mode),
      },
      name,
    ),
  );
  const showMode = () =>
    modes.forEach((button, i) =>
      button.setAttribute('aria-pressed', MODE_NAMES[i][0] === settings.get('mode')),
    );
  settings.on('mode', showMode);
  showMode();

  const preset = (name, key) =>
    element(
      'button',
      {
        type: 'button',
        title: `From the ${name}${name === 'side' ? ', the robot looks to the right' : ''} (${key})`,
        onclick: () => stage.frameAll(name),
      },
      name[0].toUpperCase() + name.slice(1),
    );

  const follow = element('select', {
    'aria-label': 'What the camera follows',
    title: 'What the camera follows (f)',
    onchange: () => settings.set('follow', follow.value || null),
  });
  const showFollow = () => {
    const links = [...new Set([selection.name, settings.get('follow')])].filter(
      (name) => name && name !== 'com',
    );
    follow.replaceChildren(
      element('option', { value: '' }, 'No follow'),
      element('option', { value: 'com' }, 'Follow COM'),
      ...links.map((name) => element('option', { value: name }, `Follow ${name}`)),
    );
    follow.value = settings.get('follow') ?? '';
  };
  settings.on('follow', showFollow);
  selection.on('change', showFollow);
  showFollow();

  host.append(
    element('div', { class: 'segments', role: 'group', 'aria-label': 'Shapes' }, ...modes),
    element(
      'div',
      { class: 'segments', role: 'group', 'aria-label': 'Camera' },
      iconButton('frame', 'Frame all (a)', () => stage.frameAll()),
      preset('front', 'shift f'),
      preset('side', 'shift s'),
      preset('top', 'shift t'),
    ),
    follow,
    marksMenu(host, run, stage, settings),
  );
  byId('capture').append(...captureButtons(run, stage));
}

/** A picture of the view, and a video of it where the browser can make one. */
function captureButtons(run, stage) {
  const name = run.header.model || 'run';
  const video = new Video(stage, name);
  const record = iconButton('video', 'Begin a video of the view', () => {
    if (video.running) video.stop();
    else video.start();
    record.setAttribute('aria-pressed', video.running);
    record.title = video.running ? 'End the video and save it' : 'Begin a video of the view';
    record.setAttribute('aria-label', record.title);
  });
  return [
    iconButton('picture', 'Save a picture of the view', () => savePicture(stage, name)),
    ...(Video.possible() ? [record] : []),
  ];
}

/** A button that opens a legend of the marks, each with its switch. */
function marksMenu(host, run, stage, settings) {
  const has = {
    forces: run.mostContacts() > 0,
    contacts: run.mostContacts() > 0,
    cop: run.live !== undefined || run.cop.some(Number.isFinite),
    goals: run.header.goals.length > 0,
  };
  const rows = MARKS.filter(([key]) => has[key] ?? true).map(([key, name]) => {
    const box = element('input', {
      type: 'checkbox',
      onchange: () => settings.set(key, box.checked),
    });
    box.checked = settings.get(key);
    settings.on(key, (shown) => (box.checked = shown));
    const swatch = element('span', { class: `mark ${SWATCH_CLASS[key]}` });
    swatch.style.setProperty('--mark', SWATCHES[key]);
    return element('label', {}, box, swatch, name);
  });
  if (has.forces) rows.splice(1, 0, forceScale(stage, settings));
  const menu = element(
    'div',
    { class: 'menu', hidden: true, id: 'marks' },
    ...rows,
    stage.planes.length > 0
      ? element(
          'p',
          { class: 'quiet' },
          `Grid: ${number(stage.cell)} m and ${number(10 * stage.cell)} m`,
        )
      : null,
  );
  const button = element(
    'button',
    {
      type: 'button',
      class: 'labelled',
      'aria-expanded': 'false',
      'aria-controls': 'marks',
      title: 'What the marks mean, and which to show',
      onclick: () => open(menu.hidden),
    },
    icon('eye'),
    'Marks',
  );
  const open = (show) => {
    menu.hidden = !show;
    menu.classList.toggle('to-left', show && box.offsetLeft + menu.offsetWidth > host.clientWidth);
    button.setAttribute('aria-expanded', show);
  };
  const box = element('div', { class: 'with-menu' }, button, menu);
  document.addEventListener('pointerdown', (event) => {
    if (!box.contains(event.target)) open(false);
  });
  box.addEventListener('keydown', (event) => {
    if (event.key !== 'Escape' || menu.hidden) return;
    open(false);
    button.focus();
    event.stopPropagation();
  });
  return box;
}

/** The length of force arrows, on a scale of decades. */
function forceScale(stage, settings) {
  const text = element('output', { class: 'quiet' });
  const slider = element('input', {
    type: 'range',
    min: -1,
    max: 1,
    step: 0.05,
    'aria-label': 'Length of force arrows',
    oninput: () => settings.set('forceScale', 10 ** slider.valueAsNumber),
  });
  const show = () => {
    slider.value = Math.log10(settings.get('forceScale'));
    text.textContent = `${number(0.1 / stage.contacts.metresPerNewton, 2)} N / 10 cm`;
  };
  settings.on('forceScale', show);
  show();
  return element('div', { class: 'force-scale' }, slider, text);
}
