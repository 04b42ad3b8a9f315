// SPDX-License-Identifier: Apache-2.0
// The other way around than payload.js: a run as the text that a page holds.

const TYPES = new Map([
  [Float32Array, 'f32'],
  [Float64Array, 'f64'],
  [Uint32Array, 'u32'],
  [Uint16Array, 'u16'],
  [Uint8Array, 'u8'],
]);
const upTo8 = (bytes) => Math.ceil(bytes / 8) * 8;

function toBase64(bytes) {
  const parts = [];
  for (let i = 0; i < bytes.length; i += 0x8000)
    parts.push(String.fromCharCode(...bytes.subarray(i, i + 0x8000)));
  return btoa(parts.join(''));
}

/** `arrays`: typed arrays by name, which the header need not list. A promise of base64. */
export async function packRun(header, arrays) {
  const listed = {};
  let size = 0;
  for (const [name, array] of Object.entries(arrays)) {
    listed[name] = { type: TYPES.get(array.constructor), offset: size, length: array.length };
    size += upTo8(array.byteLength);
  }
  const json = new TextEncoder().encode(JSON.stringify({ ...header, arrays: listed }));
  const start = 16 + upTo8(json.length);
  const bytes = new Uint8Array(start + size);
  bytes.set(new TextEncoder().encode('SGREPLAY'));
  bytes.fill(32, 16, start); // JSON ends in spaces
  bytes.set(json, 16);
  const view = new DataView(bytes.buffer);
  view.setUint32(8, 1, true);
  view.setUint32(12, start - 16, true);
  for (const [name, array] of Object.entries(arrays))
    bytes.set(
      new Uint8Array(array.buffer, array.byteOffset, array.byteLength),
      start + listed[name].offset,
    );
  const deflated = new Blob([bytes]).stream().pipeThrough(new CompressionStream('deflate'));
  return toBase64(new Uint8Array(await new Response(deflated).arrayBuffer()));
}
