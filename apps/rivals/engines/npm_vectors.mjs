// SPDX-License-Identifier: Apache-2.0
// Vectors and quaternions (w first) of scenes, as arrays.
export const add = (a, b) => a.map((x, i) => x + b[i]);
export const minus = (a, b) => a.map((x, i) => x - b[i]);
export const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const conjugate = ([w, x, y, z]) => [w, -x, -y, -z];
export const times = ([w, ...u], [s, ...v]) => [w * s - dot(u, v), ...add(add(v.map((x) => w * x), u.map((x) => s * x)), cross(u, v))];
export const turned = (q, v) => times(times(q, [0, ...v]), conjugate(q)).slice(1);

const world = {position: [0, 0, 0], orientation: [1, 0, 0, 0], velocity: [0, 0, 0], angular_velocity: [0, 0, 0]};
// The body of that number, or the world as one that rests.
export const bodyOf = (scene, i) => (i < 0 ? world : scene.bodies[i]);
// A point and a direction of the world, in a body as it starts.
export const pointIn = (b, p) => turned(conjugate(b.orientation), minus(p, b.position));
export const directionIn = (b, v) => turned(conjugate(b.orientation), v);
// The joint of a tree that carries a body.
export const carrierOf = (scene, i) => scene.joints.find((j) => j.child === i && j.kind !== 'tie');

// The force along a joint's axis at a time after the start.
export const forceAt = (j, time) => (j.program ?? []).reduce((f, [from, value]) => (time >= from - 1e-9 ? value : f), j.force);
export const isDriven = (j) => j.force !== 0 || j.program !== undefined;

export function jointSpeed(scene, j) {
  const p = bodyOf(scene, j.parent), c = bodyOf(scene, j.child);
  if (j.kind !== 'slider') return dot(j.axis, minus(c.angular_velocity, p.angular_velocity));
  const at = (b) => add(b.velocity, cross(b.angular_velocity, minus(j.anchor, b.position)));
  return dot(j.axis, minus(at(c), at(p)));
}
