// SPDX-License-Identifier: Apache-2.0
// The run inside the page: base64 of a zlib stream of "SGREPLAY", u32 version, u32 n, n bytes of
// JSON, then the binary section with the arrays that the JSON names. Little-endian throughout.

const VERSION = 1;
const KINDS = {
  f32: Float32Array,
  f64: Float64Array,
  u32: Uint32Array,
  u16: Uint16Array,
  u8: Uint8Array,
};

function fromBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(bytes) {
  if (typeof DecompressionStream === 'undefined')
    throw new Error(
      'This browser is too old to unpack the run: it lacks DecompressionStream. ' +
        'Chromium 80, Firefox 113 and Safari 16.4 have it.',
    );
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).arrayBuffer().catch(() => {
    throw new Error('The run in this page is damaged: it cannot be unpacked.');
  });
}

/** Returns {header, array(name)}; the arrays are views, nothing is copied. */
export async function readPayload(text) {
  if (text.startsWith('@')) throw new Error('This page is the template: it holds no run.');
  const buffer = await inflate(fromBase64(text));
  const view = new DataView(buffer);
  const magic = new TextDecoder().decode(new Uint8Array(buffer, 0, 8));
  if (magic !== 'SGREPLAY') throw new Error('The data in this page is not a run of softgauss.');
  const version = view.getUint32(8, true);
  if (version !== VERSION)
    throw new Error(`The run has format ${version}; this page reads format ${VERSION}.`);
  const length = view.getUint32(12, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 16, length)));
  const start = 16 + length;
  const array = (name) => {
    const { type, offset, length: count } = header.arrays[name];
    return new KINDS[type](buffer, start + offset, count);
  };
  return { header, array };
}
