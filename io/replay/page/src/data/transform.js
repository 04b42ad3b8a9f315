// SPDX-License-Identifier: Apache-2.0
// Rotations as unit quaternions [w, x, y, z]; poses as seven numbers x y z w x y z in an array.

export function multiply(a, b) {
  return [
    a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
    a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
    a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
    a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
  ];
}

export const conjugate = (q) => [q[0], -q[1], -q[2], -q[3]];

/** q v q*, with v + 2 w (u × v) + 2 u × (u × v). */
export function rotate(q, v) {
  const [w, x, y, z] = q;
  const tx = 2 * (y * v[2] - z * v[1]);
  const ty = 2 * (z * v[0] - x * v[2]);
  const tz = 2 * (x * v[1] - y * v[0]);
  return [
    v[0] + w * tx + y * tz - z * ty,
    v[1] + w * ty + z * tx - x * tz,
    v[2] + w * tz + x * ty - y * tx,
  ];
}

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const norm = (a) => Math.hypot(a[0], a[1], a[2]);
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** Position and rotation of pose number `i` of `poses`. */
export const positionOf = (poses, i) => [poses[7 * i], poses[7 * i + 1], poses[7 * i + 2]];
export const rotationOf = (poses, i) => [
  poses[7 * i + 3],
  poses[7 * i + 4],
  poses[7 * i + 5],
  poses[7 * i + 6],
];

/** A pose {p, q} in the frame number `i` of `poses`, seen from the world. */
export function placed(poses, i, local) {
  const q = rotationOf(poses, i);
  return { p: add(positionOf(poses, i), rotate(q, local.p)), q: multiply(q, local.q) };
}

/**
 * Writes into `out` at `o` the pose between those at `a` and `b` of `poses`, at fraction s: the
 * straight line between the positions, the shortest turn at constant speed between the rotations.
 */
export function interpolate(poses, a, b, s, out, o) {
  for (let k = 0; k < 3; ++k) out[o + k] = poses[a + k] + s * (poses[b + k] - poses[a + k]);
  let cosine = 0;
  for (let k = 3; k < 7; ++k) cosine += poses[a + k] * poses[b + k];
  const sign = cosine < 0 ? -1 : 1;
  cosine = Math.min(1, sign * cosine);
  let u = 1 - s;
  let v = s;
  // Below that angle the chord is as good as the arc.
  if (cosine < 1 - 1e-10) {
    const angle = Math.acos(cosine);
    u = Math.sin(u * angle) / Math.sin(angle);
    v = Math.sin(v * angle) / Math.sin(angle);
  }
  let length = 0;
  for (let k = 3; k < 7; ++k) {
    out[o + k] = u * poses[a + k] + sign * v * poses[b + k];
    length += out[o + k] * out[o + k];
  }
  length = Math.sqrt(length);
  for (let k = 3; k < 7; ++k) out[o + k] /= length;
}

/** Roll, pitch and yaw about fixed x, y, z, as URDF has them [rad]. */
export function rollPitchYaw([w, x, y, z]) {
  return [
    Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
    Math.asin(Math.max(-1, Math.min(1, 2 * (w * y - z * x)))),
    Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
  ];
}
