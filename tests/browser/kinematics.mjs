// SPDX-License-Identifier: Apache-2.0
// A URDF's links for a row of a log, by 4 × 4 matrices: an oracle for the page that shares nothing
// with it or with the engine.
//
// pose(child) = pose(parent) · origin · joint(q), from the root, which the log places. The centre of
// mass is Σ m c / Σ m over the links that can move.

import { readFileSync } from 'node:fs';

export const product = (A, B) =>
  A.map((_, i) => B[0].map((_, j) => A[i].reduce((sum, a, k) => sum + a * B[k][j], 0)));

/** Rotation by an angle about a unit axis, and a shift. */
function motion([x, y, z], angle, shift = [0, 0, 0]) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  const t = 1 - c;
  return [
    [c + t * x * x, t * x * y - s * z, t * x * z + s * y, shift[0]],
    [t * x * y + s * z, c + t * y * y, t * y * z - s * x, shift[1]],
    [t * x * z - s * y, t * y * z + s * x, c + t * z * z, shift[2]],
    [0, 0, 0, 1],
  ];
}

const numbers = (text, missing) => (text ? text.trim().split(/\s+/).map(Number) : missing);

const attribute = (tag, name) => tag?.match(new RegExp(`${name}\\s*=\\s*"([^"]*)"`))?.[1];
const tagOf = (text, name) => text.match(new RegExp(`<${name}\\s[^>]*>`))?.[0];

function originOf(text) {
  const tag = tagOf(text, 'origin');
  const [roll, pitch, yaw] = numbers(attribute(tag, 'rpy'), [0, 0, 0]);
  const turn = product(
    product(motion([0, 0, 1], yaw), motion([0, 1, 0], pitch)),
    motion([1, 0, 0], roll),
  );
  return product(motion([0, 0, 1], 0, numbers(attribute(tag, 'xyz'), [0, 0, 0])), turn);
}

function readJoint([, head, body]) {
  const axis = numbers(attribute(tagOf(body, 'axis'), 'xyz'), [1, 0, 0]);
  const limit = (name) => Number(attribute(tagOf(body, 'limit'), name));
  return {
    name: attribute(head, 'name'),
    type: attribute(head, 'type'),
    parent: attribute(tagOf(body, 'parent'), 'link'),
    child: attribute(tagOf(body, 'child'), 'link'),
    origin: originOf(body),
    axis: axis.map((x) => x / Math.hypot(...axis)),
    lower: limit('lower'),
    upper: limit('upper'),
    effort: limit('effort'),
  };
}

/** Visual shapes that are a sphere, a cylinder or a box: pose in the link, half extents, rgba. */
function readVisuals(body, materials) {
  return [...body.matchAll(/<visual>(.*?)<\/visual>/gs)].map(([, visual]) => {
    const value = (tag, name) => Number(attribute(tagOf(visual, tag), name));
    const radius = value('sphere', 'radius') || value('cylinder', 'radius');
    const halfExtents = tagOf(visual, 'box')
      ? numbers(attribute(tagOf(visual, 'box'), 'size')).map((x) => x / 2)
      : [radius, radius, value('cylinder', 'length') / 2 || radius];
    const material = attribute(tagOf(visual, 'material'), 'name');
    return { origin: originOf(visual), halfExtents, rgba: materials.get(material) };
  });
}

export function readUrdf(file) {
  const text = readFileSync(file, 'utf8').replace(/<!--.*?-->/gs, '');
  const materials = new Map(
    [...text.matchAll(/<material\s+name="([^"]*)">\s*(<color[^>]*>)/g)].map(([, name, color]) => [
      name,
      numbers(attribute(color, 'rgba')),
    ]),
  );
  const joints = [...text.matchAll(/<joint\s([^>]*)>(.*?)<\/joint>/gs)].map(readJoint);
  const elements = [...text.matchAll(/<link\s([^>]*?)(?:\/>|>(.*?)<\/link>)/gs)];
  const links = elements.map(([, head]) => attribute(head, 'name'));
  const inertias = new Map();
  const visuals = new Map();
  elements.forEach(([, , body = ''], i) => {
    const inertial = body.match(/<inertial>(.*?)<\/inertial>/s)?.[1] ?? '';
    const mass = Number(attribute(tagOf(inertial, 'mass'), 'value') ?? 0);
    inertias.set(links[i], { mass, origin: originOf(inertial) });
    visuals.set(links[i], readVisuals(body, materials));
  });
  return {
    joints,
    links,
    inertias,
    visuals,
    mass: [...inertias.values()].reduce((sum, { mass }) => sum + mass, 0),
    root: links.find((link) => joints.every((joint) => joint.child !== link)),
  };
}

/** Where a matrix puts the origin. */
export const position = (matrix) => [0, 1, 2].map((i) => matrix[i][3]);

/** Of what can move: a root without coordinates belongs to the world, so does what is fixed to it. */
export function centerOfMass({ inertias, joints, root }, poses, row) {
  const isFloating = row.has(`q:${root}.x`);
  const isWorld = (link) => {
    if (link === root) return !isFloating;
    const joint = joints.find(({ child }) => child === link);
    return joint.type === 'fixed' && isWorld(joint.parent);
  };
  const sum = [0, 0, 0];
  let total = 0;
  for (const [link, { mass, origin }] of inertias) {
    if (isWorld(link)) continue;
    total += mass;
    position(product(poses.get(link), origin)).forEach((x, i) => (sum[i] += mass * x));
  }
  return sum.map((x) => x / total);
}

/** Velocity of a link's origin and angular velocity, from its poses `step` apart on both sides. */
export function velocity(before, after, step) {
  const linear = position(after).map((x, i) => (x - position(before)[i]) / step);
  // The skew part of after · beforeᵀ is the sine of the turn between them.
  const turn = [0, 1, 2].map((i) =>
    [0, 1, 2].map((j) => [0, 1, 2].reduce((sum, k) => sum + after[i][k] * before[j][k], 0)),
  );
  const angular = [turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]];
  return { linear, angular: angular.map((x) => x / (2 * step)) };
}

/** The rows of a log: maps from column to number. */
export function readLog(file) {
  const [head, ...rows] = readFileSync(file, 'utf8')
    .trim()
    .split('\n')
    .map((line) => line.split(','));
  return rows.map((row) => new Map(head.map((name, i) => [name, Number(row[i])])));
}

/** Pose of every link, as a matrix, by name. */
export function linkPoses({ joints, root }, row) {
  const base = (part) => row.get(`q:${root}.${part}`);
  let pose = motion([0, 0, 1], 0);
  if (base('x') !== undefined) {
    const q = ['qx', 'qy', 'qz'].map(base);
    const sine = Math.hypot(...q);
    pose = motion(
      sine > 0 ? q.map((x) => x / sine) : [0, 0, 1],
      2 * Math.atan2(sine, base('qw')),
      ['x', 'y', 'z'].map(base),
    );
  }
  const poses = new Map([[root, pose]]);
  const visit = (link) =>
    joints
      .filter((joint) => joint.parent === link)
      .forEach((joint) => {
        const q = row.get(`q:${joint.name}`) ?? 0;
        const moved =
          joint.type === 'prismatic'
            ? motion(
                [0, 0, 1],
                0,
                joint.axis.map((x) => q * x),
              )
            : motion(joint.axis, q);
        poses.set(joint.child, product(product(poses.get(link), joint.origin), moved));
        visit(joint.child);
      });
  visit(root);
  return poses;
}

/** How far a pose is from a matrix: metres, and the largest error in the rotation's entries. */
export function difference({ position, quaternion: [w, x, y, z] }, matrix) {
  const rotation = [
    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
  ];
  const turn = Math.max(
    ...rotation.flatMap((row, i) => row.map((value, j) => Math.abs(value - matrix[i][j]))),
  );
  return { metres: Math.hypot(...position.map((value, i) => value - matrix[i][3])), turn };
}
