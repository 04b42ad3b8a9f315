// SPDX-License-Identifier: Apache-2.0

// Vectors, quaternions (w first) and poses {p, q}: what scenes and their conversion need.

export const add = (a, b) => a.map((x, i) => x + b[i]);
export const scale = (s, a) => a.map((x) => s * x);
export const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
export const norm = (a) => Math.sqrt(dot(a, a));
export const normalized = (a) => scale(1 / norm(a), a);
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

export const multiply = ([w, x, y, z], [W, X, Y, Z]) => [
  w * W - x * X - y * Y - z * Z,
  w * X + x * W + y * Z - z * Y,
  w * Y - x * Z + y * W + z * X,
  w * Z + x * Y - y * X + z * W,
];
export const conjugate = ([w, x, y, z]) => [w, -x, -y, -z];

// R(q) v
export function rotate(q, v) {
  const u = q.slice(1);
  const t = scale(2, cross(u, v));
  return add(add(v, scale(q[0], t)), cross(u, t));
}

export function axisAngle(axis, angle) {
  return [Math.cos(angle / 2), ...scale(Math.sin(angle / 2), normalized(axis))];
}

// Fixed-axis roll, pitch, yaw of a URDF.
export function rpy([roll, pitch, yaw]) {
  return multiply(
    axisAngle([0, 0, 1], yaw),
    multiply(axisAngle([0, 1, 0], pitch), axisAngle([1, 0, 0], roll)),
  );
}

// Columns of the rotation matrix.
export const axes = (q) => [rotate(q, [1, 0, 0]), rotate(q, [0, 1, 0]), rotate(q, [0, 0, 1])];

export const identity = { p: [0, 0, 0], q: [1, 0, 0, 0] };
export const compose = (a, b) => ({ p: add(a.p, rotate(a.q, b.p)), q: multiply(a.q, b.q) });
export function inverse(a) {
  const q = conjugate(a.q);
  return { p: scale(-1, rotate(q, a.p)), q };
}
