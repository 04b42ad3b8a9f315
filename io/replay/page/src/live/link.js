// SPDX-License-Identifier: Apache-2.0
// The connection to the simulation. Emits `frame`, `status`, `writes`, `connected`, `refused`.
//
// Of frames that come faster than pictures the newest is shown; of moves one a picture is sent.
//
// A move is {move: {target}} of what is held, or {target: {goal, place}}.

import { Emitter } from '../app/emitter.js';

const RETRY_MS = 1000;

export class Link extends Emitter {
  constructor(run) {
    super();
    this.run = run;
    this.connected = false;
    this.wasConnected = false;
    this.writes = false;
    this.status = null;
    this.newest = null;
    this.next = 1;
    this.waiting = new Map();
    this.moved = null;
    this.#connect();
  }

  #connect() {
    const scheme = window.location.protocol === 'https:' ? 'wss' : 'ws';
    this.socket = new WebSocket(`${scheme}://${window.location.host}${this.run.live.path}`);
    this.socket.binaryType = 'arraybuffer';
    this.seen = 0; // frames and statuses of this connection
    this.socket.addEventListener('open', () => this.#setConnected(true));
    this.socket.addEventListener('message', ({ data }) => this.#take(data));
    this.socket.addEventListener('close', () => {
      this.#setConnected(false);
      for (const { reject } of this.waiting.values()) reject(new Error('the connection is gone'));
      this.waiting.clear();
      setTimeout(() => this.#connect(), RETRY_MS);
    });
  }

  #setConnected(connected) {
    if (!connected) this.#setWrites(false);
    if (connected === this.connected) return;
    this.connected = connected;
    this.wasConnected ||= connected;
    this.emit('connected', connected);
  }

  #setWrites(writes) {
    this.writes = writes;
    this.emit('writes', writes);
  }

  #take(data) {
    if (typeof data !== 'string') {
      this.newest = data;
      this.#acknowledge();
      return;
    }
    const message = JSON.parse(data);
    if (message.status) {
      if (message.status.loads !== this.run.live.loads) {
        window.location.reload(); // the run has begun anew, with other files than this page has
        return;
      }
      this.status = message.status;
      this.#acknowledge();
      this.emit('status', message.status);
    } else if ('writes' in message) {
      this.#setWrites(message.writes);
    } else if (this.waiting.has(message.re)) {
      const { resolve, reject } = this.waiting.get(message.re);
      this.waiting.delete(message.re);
      if (message.refused) reject(new Error(message.refused));
      else resolve();
    }
  }

  /** The server keeps little on its way to who has not said that the last has come. */
  #acknowledge() {
    this.seen += 1;
    this.#send({ seen: this.seen });
  }

  /** To be called before every picture. */
  tick() {
    this.sendMove();
    if (!this.newest) return;
    const taken = this.run.take(this.newest);
    this.newest = null;
    if (taken) this.emit('frame');
  }

  #send(message) {
    if (this.connected) this.socket.send(JSON.stringify(message));
  }

  /** Asks for something, {pause: {on: true}}; a promise that it is done. */
  ask(what) {
    const id = this.next++;
    return new Promise((resolve, reject) => {
      if (!this.connected) {
        reject(new Error('there is no connection'));
        return;
      }
      this.waiting.set(id, { resolve, reject });
      this.#send({ id, ...what });
    });
  }

  /** The same for who does not wait; a refusal is shown. */
  tell(what) {
    return this.ask(what).catch((error) => this.emit('refused', error.message));
  }

  move(what) {
    this.moved = what;
  }

  /** What still waits is sent now: the next picture is due, or the point was let go. */
  sendMove() {
    if (this.moved?.target) this.tell(this.moved);
    else if (this.moved) this.#send(this.moved);
    this.moved = null;
  }
}
