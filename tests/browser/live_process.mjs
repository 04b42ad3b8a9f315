// SPDX-License-Identifier: Apache-2.0
// A live run: the process, its address, and what it leaves behind.

import { spawn } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';

const children = new Set();

export class LiveProcess {
  /** Where a test has failed, nothing goes on. */
  static killAll() {
    for (const child of children) child.kill('SIGKILL');
  }

  /** simulate_gdd ARGUMENTS --live 0, whose outputs go to FOLDER/NAME.… */
  static start(simulator, folder, name, args) {
    const process = new LiveProcess(folder, name);
    const outputs = ['log', 'summary', 'record'].flatMap((output) => [
      `--${output}`,
      process.file(output),
    ]);
    process.arguments = args;
    process.child = spawn(simulator, [...args, '--live', '0', ...outputs], {
      stdio: ['ignore', 'pipe', 'inherit'],
    });
    children.add(process.child);
    process.ended = new Promise((resolve) => process.child.on('exit', resolve));
    return new Promise((resolve, reject) => {
      process.child.stdout.on('data', (text) => {
        process.out += text;
        const [, address] = process.out.match(/^live: (\S+)$/m) ?? [];
        if (!address) return;
        process.address = address;
        resolve(process);
      });
      process.ended.then((code) => reject(new Error(`it ended with ${code}: ${process.out}`)));
    });
  }

  constructor(folder, name) {
    this.folder = folder;
    this.name = name;
    this.out = '';
  }

  file(output) {
    const extension = { log: 'csv', summary: 'json', record: 'yaml' }[output];
    return join(this.folder, `${this.name}.${extension}`);
  }

  /** Interrupts it; the exit code. */
  stop() {
    this.child.kill('SIGINT');
    return this.ended;
  }

  summary() {
    return JSON.parse(readFileSync(this.file('summary'), 'utf8'));
  }

  /** Rows of the log as maps from column to number. */
  log() {
    const [head, ...rows] = readFileSync(this.file('log'), 'utf8').trimEnd().split('\n');
    const columns = head.split(',').map((name) => name.replaceAll('"', ''));
    return rows.map((row) =>
      Object.fromEntries(row.split(',').map((cell, i) => [columns[i], cell === '' ? NaN : Number(cell)])),
    );
  }

  events() {
    return readFileSync(this.file('record'), 'utf8');
  }
}
