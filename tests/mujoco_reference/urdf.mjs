// SPDX-License-Identifier: Apache-2.0

// The project's own URDFs as scenes.
//
// Reads what those files use: inertials without rotation, primitive collision shapes, fixed and
// revolute joints, ranges, damping. A cylinder with a sphere at either end is a capsule, as in our
// importer. Anything else is an error.

import { readFileSync } from 'node:fs';

import { add, norm, rotate, rpy, scale } from './geometry.mjs';
import { Scene, box, capsule, cylinder, sphere } from './scene.mjs';

// Elements as {tag, attributes, children}.
function parseXml(text) {
  const root = { tag: '', attributes: {}, children: [] };
  const stack = [root];
  const plain = text.replace(/<!--[\s\S]*?-->/g, '').replace(/<\?[\s\S]*?\?>/g, '');
  for (const [, close, tag, attributes, self] of plain.matchAll(/<(\/?)([\w:]+)([^>]*?)(\/?)>/g)) {
    if (close) {
      stack.pop();
      continue;
    }
    const list = [...attributes.matchAll(/([\w:]+)\s*=\s*"([^"]*)"/g)].map(([, key, value]) => [key, value]);
    const item = { tag, attributes: Object.fromEntries(list), children: [] };
    stack.at(-1).children.push(item);
    if (!self) stack.push(item);
  }
  return root.children[0];
}

const child = (item, tag) => item.children.find((c) => c.tag === tag);
const children = (item, tag) => item.children.filter((c) => c.tag === tag);
const numbers = (text) => text.trim().split(/\s+/).map(Number);

function originOf(item) {
  const { xyz = '0 0 0', rpy: angles } = child(item, 'origin')?.attributes ?? {};
  return { position: numbers(xyz), quaternion: angles ? rpy(numbers(angles)) : undefined };
}

function shapeOf(item) {
  const shape = child(item, 'geometry').children[0];
  const { radius, length, size } = shape.attributes;
  switch (shape.tag) {
    case 'sphere':
      return sphere(Number(radius));
    case 'cylinder':
      return cylinder(Number(radius), Number(length) / 2);
    case 'box':
      return box(...numbers(size).map((s) => s / 2));
    default:
      throw new Error(`URDF shape ${shape.tag}`);
  }
}

// Cylinders with both ends capped become capsules; the caps go.
function recogniseCapsules(shapes) {
  const kTolerance = 1e-6;
  const caps = new Set();
  const capsules = shapes.map((g) => {
    if (g.kind !== 'cylinder') return g;
    const found = [-1, 1].map((sign) => {
      const along = rotate(g.quaternion ?? [1, 0, 0, 0], [0, 0, sign * g.halfLength]);
      const end = add(g.position, along);
      return shapes.find(
        (s) =>
          s.kind === 'sphere' &&
          Math.abs(s.radius - g.radius) < kTolerance * g.radius &&
          norm(add(s.position, scale(-1, end))) < kTolerance * (g.radius + g.halfLength),
      );
    });
    if (!found[0] || !found[1]) return g;
    found.forEach((cap) => caps.add(cap));
    return { ...g, ...capsule(g.radius, g.halfLength) };
  });
  return capsules.filter((g, i) => !caps.has(shapes[i]));
}

function addLink(scene, item, options) {
  const { name } = item.attributes;
  if (name === 'world') return;
  const inertial = child(item, 'inertial');
  if (inertial) {
    const { position, quaternion } = originOf(inertial);
    if (quaternion) throw new Error(`link ${name}: a turned inertial`);
    const I = child(inertial, 'inertia').attributes;
    const six = [I.ixx, I.iyy, I.izz, I.ixy, I.ixz, I.iyz].map(Number);
    scene.link(name, Number(child(inertial, 'mass').attributes.value), six, position);
  } else {
    scene.link(name);
  }
  if (options.withoutShapes?.includes(name)) return;
  const shapes = children(item, 'collision').map((c) => ({ ...shapeOf(c), ...originOf(c) }));
  recogniseCapsules(shapes).forEach((shape, i) => scene.geometry(`${name}_${i}`, name, shape));
}

function addJoint(scene, item) {
  const { name, type } = item.attributes;
  if (!['fixed', 'revolute'].includes(type)) throw new Error(`joint ${name}: type ${type}`);
  const more = originOf(item);
  if (type !== 'fixed') {
    const limit = child(item, 'limit').attributes;
    more.axis = numbers(child(item, 'axis').attributes.xyz);
    more.range = [Number(limit.lower), Number(limit.upper)];
    more.damping = Number(child(item, 'dynamics').attributes.damping);
  }
  const link = (tag) => child(item, tag).attributes.link;
  scene.joint(name, type, link('parent'), link('child'), more);
}

// The scene of data/robots/<name>.urdf. Its root link, unless called world, hangs from the world by
// a joint `root` of the given type and pose. `withoutShapes` names links that do not collide.
export function robotScene(name, options = {}) {
  const file = new URL(`../../data/robots/${name}.urdf`, import.meta.url);
  const robot = parseXml(readFileSync(file, 'utf8'));
  const scene = new Scene();
  const inner = new Set(children(robot, 'joint').map((j) => child(j, 'child').attributes.link));
  const roots = children(robot, 'link').map((l) => l.attributes.name);
  const root = roots.find((link) => !inner.has(link));
  if (root !== 'world') scene.joint('root', options.root ?? 'floating', 'world', root, options.pose ?? {});
  for (const item of robot.children) {
    if (item.tag === 'link') addLink(scene, item, options);
    if (item.tag === 'joint') addJoint(scene, item);
  }
  return scene;
}
