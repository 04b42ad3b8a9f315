// SPDX-License-Identifier: Apache-2.0
// Images on surfaces, from the bytes in the run. Nothing is fetched.

import { RepeatWrapping, SRGBColorSpace, Texture } from 'three';

const LARGEST = 4096; // pixels across; what is larger is drawn smaller

/** Puts an image of the run on a material, once it is decoded; a promise. */
export async function showImage(run, index, material) {
  const { bytes, type } = run.header.images[index];
  const options = { imageOrientation: 'flipY', premultiplyAlpha: 'none' };
  const blob = new Blob([run.array(bytes)], { type });
  let bitmap = await createImageBitmap(blob, options);
  const across = Math.max(bitmap.width, bitmap.height);
  if (across > LARGEST) {
    const [resizeWidth, resizeHeight] = [bitmap.width, bitmap.height].map((pixels) =>
      Math.max(1, Math.round((pixels * LARGEST) / across)),
    );
    bitmap = await createImageBitmap(blob, { ...options, resizeWidth, resizeHeight });
  }
  const texture = new Texture(bitmap);
  texture.flipY = false; // the bitmap is
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = texture.wrapT = RepeatWrapping;
  texture.anisotropy = 8;
  texture.needsUpdate = true;
  material.map = texture;
  material.needsUpdate = true;
}
