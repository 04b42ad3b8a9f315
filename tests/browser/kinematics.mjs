// SPDX-License-Identifier: Apache-2.0
// Forward kinematics of a URDF for a row of a log, by 4 × 4 matrices: an oracle for the page that
// shares nothing with it or with the engine.
//
// pose(child) = pose(parent) · origin · joint(q), from the root, which the log places.

import { readFileSync } from 'node:fs';

const product = (A, B) =>
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

export function readUrdf(file) {
  const text = readFileSync(file, 'utf8').replace(/<!--.*?-->/gs, '');
  const attribute = (tag, name) => tag?.match(new RegExp(`${name}\\s*=\\s*"([^"]*)"`))?.[1];
  const joints = [...text.matchAll(/<joint\s([^>]*)>(.*?)<\/joint>/gs)].map(([, head, body]) => {
    const tag = (name) => body.match(new RegExp(`<${name}\\s[^>]*>`))?.[0];
    const [roll, pitch, yaw] = numbers(attribute(tag('origin'), 'rpy'), [0, 0, 0]);
    const shift = numbers(attribute(tag('origin'), 'xyz'), [0, 0, 0]);
    const turn = product(
      product(motion([0, 0, 1], yaw), motion([0, 1, 0], pitch)),
      motion([1, 0, 0], roll),
    );
    const axis = numbers(attribute(tag('axis'), 'xyz'), [1, 0, 0]);
    return {
      name: attribute(head, 'name'),
      type: attribute(head, 'type'),
      parent: attribute(tag('parent'), 'link'),
      child: attribute(tag('child'), 'link'),
      origin: product(motion([0, 0, 1], 0, shift), turn),
      axis: axis.map((x) => x / Math.hypot(...axis)),
    };
  });
  const links = [...text.matchAll(/<link\s[^>]*>/g)].map(([tag]) => attribute(tag, 'name'));
  return {
    joints,
    links,
    root: links.find((link) => joints.every((joint) => joint.child !== link)),
  };
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
