// SPDX-License-Identifier: Apache-2.0
// window.softgauss: the page by script, for tests and for those who want pictures of a run.

import { drawn } from './drawn.js';

export function makeApi({
  run,
  clock,
  settings,
  selection,
  layout,
  plots,
  stage,
  link: connection,
  poses,
  ready,
  firstFrame,
}) {
  const link = (name) => {
    const found = run.linkByName.get(name);
    if (!found) throw new Error(`there is no link "${name}"`);
    return found;
  };
  return {
    ready,
    header: run.header,
    get time() {
      return clock.time;
    },
    get playing() {
      return clock.playing;
    },
    get selected() {
      return selection.name;
    },
    get zoom() {
      return plots ? [...plots.zoom] : null;
    },
    /** Of a live run, else null: whether it is connected and writes, and its last status. */
    get live() {
      if (!connection) return null;
      const { connected, writes, status } = connection;
      return { connected, writes, status, steps: run.steps, paused: run.paused };
    },
    /** Asks a live run for something, as docs/reference/live.md has it; a promise. */
    ask: (what) => connection.ask(what),
    /** From the start of navigation to the first picture [ms]. */
    get firstFrameMs() {
      return firstFrame();
    },
    seek: (time) => clock.seek(time),
    /** Frame number i, from 0. */
    frame: (i) => clock.frame(i),
    play: () => clock.play(),
    pause: () => clock.pause(),
    select: (name) => selection.select(name === null ? null : link(name).name),
    linkPose: (name) => run.linkPose(link(name), poses()),
    drawn: () => drawn(stage, plots, run.header.origin),
    /** Where the mark of a goal's place is seen, by its number: window coordinates, or null. */
    markPosition: (mark) => stage?.markPosition(mark) ?? null,
    screenPosition: (name) => stage?.screenPosition(link(name).name) ?? null,
    /**
     * Any of: mode, theme, follow, forceScale, limits and the marks as in the settings; speed,
     * loop; preset ('home', 'front', 'side', 'top'); groups (names of plots to show); zoom
     * ([from, to] in seconds); links and plots (whether these panels are open).
     */
    setView: ({ preset, speed, loop, groups, zoom, links, plots: showPlots, ...rest }) => {
      for (const [name, value] of Object.entries(rest)) settings.set(name, value);
      if (speed !== undefined) clock.setSpeed(speed);
      if (loop !== undefined) clock.setLoop(loop);
      if (groups !== undefined) plots?.showOnly(groups);
      if (zoom !== undefined) plots?.setZoom(zoom);
      if (links !== undefined) layout.open('links', links);
      if (showPlots !== undefined) layout.open('plots', showPlots);
      if (preset !== undefined) stage?.frameAll(preset);
    },
  };
}
