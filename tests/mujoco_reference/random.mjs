// SPDX-License-Identifier: Apache-2.0

// Random numbers by seed, the same on every machine: Marsaglia's 32-bit xorshift.

import { normalized } from './geometry.mjs';

export class Random {
  constructor(seed) {
    this.state = (seed * 2654435761 + 88675123) >>> 0 || 1;
    for (let i = 0; i < 8; ++i) this.next();
  }
  next() {
    let x = this.state;
    x ^= x << 13;
    x ^= x >>> 17;
    x ^= x << 5;
    this.state = x >>> 0;
    return this.state / 4294967296;
  }
  uniform(low, high) {
    return low + (high - low) * this.next();
  }
  vector(size, bound) {
    return Array.from({ length: size }, () => this.uniform(-bound, bound));
  }
  direction() {
    return normalized(this.vector(3, 1));
  }
  quaternion() {
    return normalized(this.vector(4, 1));
  }
}
