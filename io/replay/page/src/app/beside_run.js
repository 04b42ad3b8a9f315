// SPDX-License-Identifier: Apache-2.0
// Another run beside this one: one that the page holds, or another page that is dropped on this one
// or chosen by the button.

import { readPayload } from '../data/payload.js';
import { Run } from '../data/run.js';
import { byId, element, iconButton } from './dom.js';

const RUN = /<script id="softgauss-run" type="application\/octet-stream">([^<]*)</;

const payloadIn = (text) => (RUN.exec(text)?.[1] ?? '').trim();

export class BesideRun {
  /** `host` says what is beside. */
  constructor(host, stage) {
    this.host = host;
    this.stage = stage;
    this.#offerFiles();
    const held = byId('softgauss-other-run').textContent.trim();
    byId('softgauss-other-run').textContent = '';
    if (held) this.#show(held);
  }

  async #show(payload, file = '') {
    try {
      const run = new Run(await readPayload(payload));
      this.stage.showBeside(run);
      const { model, command } = run.header;
      this.#say(`Translucent: ${file || model}`, `${model}\n${command}`);
    } catch (error) {
      this.#say(error.message);
    }
  }

  async #take(file) {
    const payload = payloadIn(await file.text());
    if (payload) await this.#show(payload, file.name);
    else this.#say(`${file.name} is no replay page of softgauss.`);
  }

  #say(text, title = text) {
    const close = () => {
      this.stage.showBeside(null);
      this.host.hidden = true;
    };
    this.host.hidden = false;
    this.host.replaceChildren(
      element('span', { title }, text),
      iconButton('close', 'Take it away', close),
    );
  }

  #offerFiles() {
    const chooser = element('input', {
      type: 'file',
      accept: '.html',
      hidden: true,
      id: 'choose-beside',
      onchange: () => {
        if (chooser.files[0]) this.#take(chooser.files[0]);
        chooser.value = '';
      },
    });
    byId('capture').append(
      iconButton('beside', 'Show another run beside this one (or drop its page here)', () =>
        chooser.click(),
      ),
      chooser,
    );
    const hasFiles = (event) => event.dataTransfer?.types.includes('Files');
    document.addEventListener('dragover', (event) => {
      if (hasFiles(event)) event.preventDefault();
    });
    document.addEventListener('drop', (event) => {
      if (!hasFiles(event)) return;
      event.preventDefault();
      const [file] = event.dataTransfer.files;
      if (file) this.#take(file);
    });
  }
}
