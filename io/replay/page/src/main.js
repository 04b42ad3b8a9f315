// SPDX-License-Identifier: Apache-2.0
// The page: reads the run, makes the panels, and keeps them in step.

import { makeApi } from './app/api.js';
import { Clock } from './app/clock.js';
import { BesideRun } from './app/beside_run.js';
import { byId, icon } from './app/dom.js';
import { listenToKeys } from './app/keys.js';
import { Layout } from './app/layout.js';
import { ownText } from './app/own_text.js';
import { Selection } from './app/selection.js';
import { MARKS, Settings } from './app/settings.js';
import { readPayload } from './data/payload.js';
import { Run } from './data/run.js';
import { Handle } from './live/handle.js';
import { Link } from './live/link.js';
import { LiveClock } from './live/live_clock.js';
import { livePanel } from './live/live_panel.js';
import { LiveRun } from './live/live_run.js';
import { liveTransport } from './live/live_transport.js';
import { ContactTable } from './panels/contact_table.js';
import { dialogs, toggleDialog } from './panels/dialogs.js';
import { Inspector } from './panels/inspector.js';
import { Plots } from './panels/plots.js';
import { toolbar } from './panels/toolbar.js';
import { transport } from './panels/transport.js';
import { Tree } from './panels/tree.js';
import { bookmarkCamera } from './view/bookmark.js';
import { Stage } from './view/stage.js';

function complain(id, text) {
  const place = byId(id);
  place.hidden = false;
  place.textContent = text;
}

/** The view, or null where there is no WebGL. */
function makeStage(run) {
  if (document.createElement('canvas').getContext('webgl2'))
    return new Stage(run, byId('canvas'));
  byId('canvas').hidden = true;
  complain(
    'no-view',
    'There is no 3D view: this browser offers no WebGL 2. ' +
      'The plots and the numbers of the links work without.',
  );
  return null;
}

function showHeader(run) {
  const { header } = run;
  byId('model').textContent = byId('model').title = header.model;
  byId('summary').textContent = header.facts[0]?.[1] ?? '';
  const { kind, message } = header.outcome;
  const reason = message || `the run ended early: ${kind}`;
  if (!['completed', 'fell'].includes(kind))
    complain('banner', `${reason[0].toUpperCase()}${reason.slice(1)}.`);
}

/** What shows the curves of a recorded run, or the panel of a live one. */
function makeSide(run, link, clock, settings, selection, pageText) {
  if (!link) {
    transport(byId('transport'), run, clock);
    return new Plots(byId('plots'), run, clock, settings, selection);
  }
  liveTransport(byId('transport'), link, clock, settings);
  livePanel(byId('plots'), link, run, settings, pageText);
  document.documentElement.dataset.live = '';
  return null;
}

function start(run, begun, pageText) {
  const link = run.live ? new Link(run) : null;
  const settings = new Settings(run);
  const theme = () => (document.documentElement.dataset.theme = settings.get('theme'));
  theme();
  settings.on('theme', theme);
  const clock = link ? new LiveClock(run, link) : new Clock(run);
  const selection = new Selection(run);
  const layout = new Layout();
  showHeader(run);
  dialogs(run);
  const stage = makeStage(run);
  clock.on('playing', () => stage?.pacing(null));
  const poses = stage?.poses ?? run.posesAt(run.start, new Float64Array(7 * run.bodies.length));

  new Tree(byId('tree'), run, selection);
  const inspector = new Inspector(byId('inspector'), run, selection);
  const contacts = run.mostContacts() > 0 ? new ContactTable(byId('contact-table'), run, stage) : null;
  if (stage) toolbar(byId('toolbar'), run, stage, settings, selection);
  const plots = makeSide(run, link, clock, settings, selection, pageText);
  const inspect = () => {
    inspector.update(clock.time, poses);
    contacts?.update(clock.time, poses);
  };
  selection.on('change', inspect);
  clock.on('time', (time) => {
    if (stage) stage.moveTo(time);
    else run.posesAt(time, poses);
    inspect();
  });
  inspect();

  for (const button of document.querySelectorAll('[data-icon]'))
    button.append(icon(button.dataset.icon));
  const themeButton = byId('toggle-theme');
  const showTheme = () =>
    themeButton.replaceChildren(icon(settings.get('theme') === 'dark' ? 'sun' : 'moon'));
  themeButton.addEventListener('click', () => settings.toggleTheme());
  settings.on('theme', showTheme);
  showTheme();
  for (const id of ['info', 'help'])
    byId(`show-${id}`).addEventListener('click', () => toggleDialog(id));

  if (stage) {
    connectStage(stage, settings, selection);
    bookmarkCamera(stage, run.header.origin);
    new BesideRun(byId('beside'), stage);
  }
  const handle = stage && link ? new Handle(run, link, stage, selection, settings) : null;
  listenToKeys({ clock, link, settings, selection, layout, plots, stage });

  let firstFrame = null;
  let hasImages = false;
  const images = stage?.showImages() ?? Promise.resolve();
  images.catch((error) => console.error(error)).finally(() => (hasImages = true));
  let last = 0;
  const tick = (now) => {
    if (clock.playing) stage?.pacing(now - last);
    last = now;
    clock.tick(now);
    stage?.draw();
    if (firstFrame === null && hasImages && (stage === null || stage.pictures > 0)) {
      firstFrame = performance.now();
      begun();
      if (!link && !window.matchMedia('(prefers-reduced-motion: reduce)').matches) clock.play();
    }
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
  return {
    run,
    clock,
    link,
    handle,
    settings,
    selection,
    layout,
    plots,
    stage,
    poses: () => poses,
    firstFrame: () => firstFrame,
  };
}

function connectStage(stage, settings, selection) {
  const label = byId('hover');
  stage.on('picked', (name) => selection.select(name));
  stage.on('hovered', (name, place) => {
    label.hidden = name === null;
    stage.canvas.style.cursor = name === null ? '' : 'pointer';
    if (name === null) return;
    label.textContent = name;
    const { left, top, width } = stage.canvas.getBoundingClientRect();
    const x = Math.min(place[0] - left + 14, width - label.offsetWidth - 6);
    label.style.transform = `translate(${x}px, ${place[1] - top + 16}px)`;
  });
  selection.on('change', (link) => stage.select(link?.name ?? null));
  settings.on('mode', (mode) => stage.setMode(mode));
  settings.on('theme', (theme) => stage.setTheme(theme));
  settings.on('follow', (what) => stage.follow(what));
  const redraw = () => (stage.changed = true);
  settings.on('forceScale', (scale) => {
    stage.contacts.scale = scale;
    stage.moveTo(stage.time);
  });
  for (const [key] of MARKS)
    settings.on(key, (shown) => {
      if (key === 'forces') stage.contacts.forces.group.visible = shown;
      else if (key === 'contacts') stage.contacts.points.visible = shown;
      else stage.marks.show({ [key]: shown });
      redraw();
    });
  stage.setTheme(settings.get('theme'));
  stage.setMode(settings.get('mode'));
  const bar = byId('toolbar');
  const fit = new ResizeObserver(() => {
    stage.covered = bar.offsetTop + bar.offsetHeight;
    stage.resize();
  });
  for (const part of [byId('view'), bar]) fit.observe(part);
}

let begun;
const ready = new Promise((resolve) => (begun = resolve));
readPayload(byId('softgauss-run').textContent.trim())
  .then((payload) => {
    const pageText = payload.header.live ? ownText(byId('softgauss-run')) : null;
    byId('softgauss-run').textContent = '';
    const run = payload.header.live ? new LiveRun(payload) : new Run(payload);
    window.softgauss = makeApi({ ...start(run, begun, pageText), ready });
  })
  .catch((error) => {
    complain('banner', error.message);
    console.error(error);
  });
