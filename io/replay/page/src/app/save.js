// SPDX-License-Identifier: Apache-2.0
// Files that the page gives to its user: text, a picture of the view, a video of it.

import { element } from './dom.js';

export function save(name, blob) {
  const url = URL.createObjectURL(blob);
  const anchor = element('a', { href: url, download: name });
  document.body.append(anchor);
  anchor.click();
  anchor.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10000);
}

/** The view as it is seen, with its background, which is a style of the page and not of the canvas. */
function paint(stage, canvas) {
  const { width, height } = stage.canvas;
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext('2d');
  const style = getComputedStyle(document.documentElement);
  const back = context.createLinearGradient(0, 0, 0, height);
  back.addColorStop(0, style.getPropertyValue('--sky').trim());
  back.addColorStop(1, style.getPropertyValue('--horizon').trim());
  context.fillStyle = back;
  context.fillRect(0, 0, width, height);
  // What was drawn is gone once the browser has shown it.
  stage.changed = true;
  stage.draw();
  context.drawImage(stage.canvas, 0, 0);
}

export function savePicture(stage, name) {
  const canvas = document.createElement('canvas');
  paint(stage, canvas);
  canvas.toBlob((blob) => save(`${name}.png`, blob), 'image/png');
}

/** A video of the view while it goes on; start() begins it, stop() saves it. */
export class Video {
  constructor(stage, name) {
    this.stage = stage;
    this.name = name;
    this.recorder = null;
  }

  static possible() {
    return typeof MediaRecorder !== 'undefined' && MediaRecorder.isTypeSupported('video/webm');
  }

  get running() {
    return this.recorder !== null;
  }

  start() {
    const canvas = document.createElement('canvas');
    const parts = [];
    paint(this.stage, canvas);
    this.recorder = new MediaRecorder(canvas.captureStream(60), {
      mimeType: 'video/webm',
      videoBitsPerSecond: 8e6,
    });
    this.recorder.addEventListener('dataavailable', ({ data }) => parts.push(data));
    this.recorder.addEventListener('stop', () => {
      const blob = new Blob(parts, { type: 'video/webm' });
      if (blob.size > 0) save(`${this.name}.webm`, blob);
      else window.alert('The browser recorded no pictures: no video was saved.');
    });
    this.recorder.start(1000);
    const frame = () => {
      if (!this.recorder) return;
      paint(this.stage, canvas);
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  stop() {
    this.recorder?.stop();
    this.recorder = null;
  }
}
