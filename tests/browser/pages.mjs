// SPDX-License-Identifier: Apache-2.0
// Replay pages opened in Chromium, watched for errors and for requests to any network.

import { createRequire } from 'node:module';
import { readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { deflateSync, inflateSync } from 'node:zlib';

// WebGL in software, the same on every machine.
const SOFTWARE = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

/** For anything to come [ms]: pictures in software beside other tests take their time. */
export const PATIENCE = 120000;

export class Browser {
  static async launch(folder, executablePath, args = SOFTWARE) {
    const { chromium } = createRequire(import.meta.url)(resolve(folder, 'playwright-core'));
    return new Browser(folder, await chromium.launch({ executablePath, args }));
  }

  constructor(folder, browser) {
    this.folder = folder;
    this.browser = browser;
    this.complaints = [];
  }

  close() {
    return this.browser.close();
  }

  /** The page of a run, loaded and paused; what it complains of is kept. */
  async open(name, options = {}) {
    const page = await this.#newPage(name, /^(file|data|blob):/, options);
    await this.#load(page, name);
    return page;
  }

  /** The page of a live run, connected. */
  async visit(address, options = {}) {
    const { origin } = new URL(address);
    const page = await this.#newPage(origin, new RegExp(`^(${origin}|data:|blob:)`), options);
    await page.goto(address);
    await page.waitForFunction(() => window.softgauss?.live.status, null, {
      polling: 100,
    });
    await page.evaluate(() => window.softgauss.ready);
    return page;
  }

  /** `allowed`: what it may ask for. */
  async #newPage(name, allowed, options) {
    const { width = 1280, height = 800, scheme = 'light', motion = 'reduce', touch = false } = options;
    const context = await this.browser.newContext({
      viewport: { width, height },
      colorScheme: scheme,
      reducedMotion: motion,
      hasTouch: touch,
      acceptDownloads: true,
    });
    context.setDefaultTimeout(PATIENCE);
    const page = await context.newPage();
    page.on('console', (message) => {
      if (message.type() === 'error') this.complaints.push(`${name}: console: ${message.text()}`);
    });
    page.on('pageerror', (error) => this.complaints.push(`${name}: ${error.stack}`));
    page.on('request', (request) => {
      if (!allowed.test(request.url())) this.complaints.push(`${name}: asked ${request.url()}`);
    });
    return page;
  }

  screenshot(page, name) {
    return page.screenshot({ path: join(this.folder, `${name}.png`) });
  }

  /**
   * The least of up to `tries` times [ms] from a call of the page to its first picture, in a
   * window that stands: a new one still loads the browser's own parts beside the page.
   */
  async leastTimeToFirstFrame(name, tries) {
    const page = await this.open(name);
    let least = Infinity;
    for (let i = 0; i < tries && !(least < 1500); i += 1) {
      await page.goto('about:blank');
      await this.#load(page, name);
      least = Math.min(least, await page.evaluate('window.softgauss.firstFrameMs'));
    }
    await page.close();
    return least;
  }

  async #load(page, name) {
    await page.goto(pathToFileURL(resolve(this.folder, `${name}.html`)).href);
    await page.waitForFunction(() => window.softgauss);
    await page.evaluate(() => window.softgauss.ready);
  }

  /** A copy of a page whose header is changed. */
  alter(name, copy, change) {
    const text = readFileSync(join(this.folder, `${name}.html`), 'utf8');
    const [, run] = text.match(/type="application\/octet-stream">([^<]*)</);
    const bytes = inflateSync(Buffer.from(run, 'base64'));
    const length = bytes.readUInt32LE(12);
    const header = JSON.parse(bytes.subarray(16, 16 + length).toString());
    change(header);
    const json = Buffer.from(JSON.stringify(header));
    const padded = Buffer.concat([json, Buffer.alloc((8 - (json.length % 8)) % 8, ' ')]);
    const start = Buffer.from(bytes.subarray(0, 16));
    start.writeUInt32LE(padded.length, 12);
    const packed = deflateSync(Buffer.concat([start, padded, bytes.subarray(16 + length)]));
    writeFileSync(
      join(this.folder, `${copy}.html`),
      text.replace(run, () => packed.toString('base64')),
    );
  }
}

/** A point of the plot of a group, at a fraction of its width. */
export async function plotPoint(page, group, fraction) {
  const over = page.locator(`section.plot[aria-label="${group}"] .u-over`);
  await over.scrollIntoViewIfNeeded();
  const { x, y, width, height } = await over.boundingBox();
  return [x + fraction * width, y + height / 2];
}
