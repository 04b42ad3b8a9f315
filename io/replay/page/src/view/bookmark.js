// SPDX-License-Identifier: Apache-2.0
// Where the camera is, in the address: #camera=x,y,z,tx,ty,tz of its place and of what it looks at,
// in the world. Who opens the address looks from there.

const KEY = 'camera=';

export function readBookmark(hash) {
  const found = hash.replace(/^#/, '').split('&').find((part) => part.startsWith(KEY));
  const numbers = found?.slice(KEY.length).split(',').map(Number) ?? [];
  return numbers.length === 6 && numbers.every(Number.isFinite) ? numbers : null;
}

/** Keeps the address in step with the camera once somebody has moved it. */
export function bookmarkCamera(stage, origin) {
  const { camera } = stage;
  const place = readBookmark(window.location.hash);
  if (place) {
    const inScene = place.map((x, i) => x - origin[i % 3]);
    camera.camera.position.fromArray(inScene);
    camera.controls.target.fromArray(inScene, 3);
    camera.controls.update();
    camera.chosen = true;
    stage.changed = true;
  }
  const write = () => {
    const numbers = [...camera.camera.position.toArray(), ...camera.controls.target.toArray()]
      .map((x, i) => (x + origin[i % 3]).toFixed(3))
      .join(',');
    try {
      window.history.replaceState(null, '', `#${KEY}${numbers}`);
    } catch {
      // Some browsers keep the address of a file as it is.
    }
  };
  // After it was let go it glides on for a while.
  let touched = false;
  let timer = null;
  camera.controls.addEventListener('start', () => (touched = true));
  camera.controls.addEventListener('end', write);
  camera.controls.addEventListener('change', () => {
    if (!touched) return;
    clearTimeout(timer);
    timer = setTimeout(write, 150);
  });
}
