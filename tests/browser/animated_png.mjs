// SPDX-License-Identifier: Apache-2.0
// One animated PNG from PNG files of equal size: every browser shows it, and others its first frame.

import { crc32 } from 'node:zlib';

/** The chunks of a PNG file, `[type, data]` each. */
function chunksOf(png) {
  const chunks = [];
  for (let at = 8; at < png.length; ) {
    const length = png.readUInt32BE(at);
    chunks.push([png.toString('latin1', at + 4, at + 8), png.subarray(at + 8, at + 8 + length)]);
    at += 12 + length;
  }
  return chunks;
}

function crcOf(bytes) {
  if (crc32) return crc32(bytes);
  let crc = 0xffffffff;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; ++bit) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return (crc ^ 0xffffffff) >>> 0;
}

function chunk(type, data) {
  const body = Buffer.concat([Buffer.from(type, 'latin1'), data]);
  const out = Buffer.alloc(body.length + 8);
  out.writeUInt32BE(data.length, 0);
  body.copy(out, 4);
  out.writeUInt32BE(crcOf(body), body.length + 4);
  return out;
}

/** `frames`: PNG files, each shown for `milliseconds`, the last one for `last`; without end. */
export function animatedPng(frames, milliseconds, last) {
  const [[, header]] = chunksOf(frames[0]);
  const control = Buffer.alloc(8);
  control.writeUInt32BE(frames.length, 0);
  const out = [frames[0].subarray(0, 8), chunk('IHDR', header), chunk('acTL', control)];
  let sequence = 0;
  frames.forEach((frame, i) => {
    const [first, ...rest] = chunksOf(frame);
    if (!first[1].equals(header)) throw new Error(`frame ${i} has another size or kind`);
    const shown = Buffer.alloc(26);
    shown.writeUInt32BE(sequence++, 0);
    header.copy(shown, 4, 0, 8);
    shown.writeUInt16BE(Math.round(i + 1 < frames.length ? milliseconds : last), 20);
    shown.writeUInt16BE(1000, 22);
    out.push(chunk('fcTL', shown));
    for (const [type, data] of rest) {
      if (type !== 'IDAT') continue;
      const number = Buffer.alloc(4);
      number.writeUInt32BE(sequence, 0);
      if (i === 0) out.push(chunk('IDAT', data));
      else {
        out.push(chunk('fdAT', Buffer.concat([number, data])));
        ++sequence;
      }
    }
  });
  return Buffer.concat([...out, chunk('IEND', Buffer.alloc(0))]);
}
