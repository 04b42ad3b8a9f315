// SPDX-License-Identifier: Apache-2.0
// Shapes of the run as three.js geometries, each made once, with a scale for each use.

import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  Color,
  CylinderGeometry,
  Matrix4,
  Quaternion,
  SphereGeometry,
  SRGBColorSpace,
  Vector3,
} from 'three';
import { withNormals } from './normals.js';

// three.js lays cylinders along y, the run along z.
const upright = (geometry) => geometry.rotateX(Math.PI / 2);

const PRIMITIVES = {
  sphere: () => upright(new SphereGeometry(1, 36, 24)),
  cylinder: () => upright(new CylinderGeometry(1, 1, 2, 40)),
  box: () => new BoxGeometry(2, 2, 2),
};

/** A file's colour as a surface has it: even what is black shows its form in the light. */
export function surfaceColor([r, g, b]) {
  const lift = (x) => Math.sqrt((x * x + 0.026) / 1.026);
  return new Color().setRGB(lift(r), lift(g), lift(b), SRGBColorSpace);
}

/** A BatchedMesh wants the same attributes everywhere: position, normal, colour and an index. */
function complete(geometry) {
  geometry.deleteAttribute('uv');
  const count = geometry.getAttribute('position').count;
  if (!geometry.getAttribute('color'))
    geometry.setAttribute('color', new BufferAttribute(new Float32Array(3 * count).fill(1), 3));
  if (!geometry.index)
    geometry.setIndex(
      new BufferAttribute(
        Uint32Array.from({ length: count }, (_, i) => i),
        1,
      ),
    );
  return geometry;
}

export class Shapes {
  #made = new Map();

  constructor(run) {
    this.run = run;
  }

  #once(key, make) {
    if (!this.#made.has(key)) this.#made.set(key, make());
    return this.#made.get(key);
  }

  /**
   * Of a shape: [{geometry, scale, opaque, coloured}]. A mesh of which parts are translucent gives
   * two; `opaque` is null where who uses the shape says. Empty for planes, which have no size.
   */
  pieces(shape) {
    switch (shape.kind) {
      case 'sphere':
        return [this.#primitive('sphere', [shape.radius, shape.radius, shape.radius])];
      case 'cylinder':
        return [this.#primitive('cylinder', [shape.radius, shape.radius, shape.halfLength])];
      case 'box':
        return [this.#primitive('box', shape.halfExtents)];
      case 'capsule':
        return [
          { geometry: this.#capsule(shape), scale: [1, 1, 1], opaque: null, coloured: false },
        ];
      case 'mesh':
        return this.#once(`mesh ${shape.mesh}`, () => this.#mesh(shape.mesh));
      default:
        return [];
    }
  }

  #primitive(kind, scale) {
    const geometry = this.#once(kind, () => complete(PRIMITIVES[kind]()));
    return { geometry, scale: scale.map((x) => Math.max(x, 1e-6)), opaque: null, coloured: false };
  }

  #capsule({ radius, halfLength }) {
    return this.#once(`capsule ${radius} ${halfLength}`, () =>
      complete(upright(new CapsuleGeometry(radius, 2 * halfLength, 12, 36))),
    );
  }

  #mesh(index) {
    const mesh = this.run.header.meshes[index];
    const vertices = this.run.array(mesh.vertices);
    const triangles = this.run.array(mesh.triangles);
    const { position, normal } = withNormals(vertices, triangles);
    if (mesh.parts.length === 0) return [this.#piece(position, normal, null, null)];
    const color = new Float32Array(position.length);
    const pieces = [];
    for (const opaque of [true, false]) {
      const parts = mesh.parts.filter((part) => part.rgba[3] >= 1 === opaque);
      if (parts.length === 0) continue;
      const corners = [];
      for (const part of parts) {
        const { r, g, b } = surfaceColor(part.rgba);
        for (let c = 3 * part.first; c < 3 * (part.first + part.count); ++c) {
          corners.push(c);
          color.set([r, g, b], 3 * c);
        }
      }
      const take = (from) =>
        Float32Array.from(
          { length: 3 * corners.length },
          (_, i) => from[3 * corners[Math.floor(i / 3)] + (i % 3)],
        );
      pieces.push(this.#piece(take(position), take(normal), take(color), opaque));
    }
    return pieces;
  }

  #piece(position, normal, color, opaque) {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(position, 3));
    geometry.setAttribute('normal', new BufferAttribute(normal, 3));
    if (color) geometry.setAttribute('color', new BufferAttribute(color, 3));
    return { geometry: complete(geometry), scale: [1, 1, 1], opaque, coloured: color !== null };
  }
}

/** Pose {p, q} in the body and scale, as a matrix. */
export function localMatrix({ p, q }, scale = [1, 1, 1]) {
  return new Matrix4().compose(
    new Vector3(...p),
    new Quaternion(q[1], q[2], q[3], q[0]),
    new Vector3(...scale),
  );
}

/** Pose number `i` of `poses` as a matrix, into `out`. */
export function bodyMatrix(poses, i, out) {
  const o = 7 * i;
  position.set(poses[o], poses[o + 1], poses[o + 2]);
  rotation.set(poses[o + 4], poses[o + 5], poses[o + 6], poses[o + 3]);
  return out.compose(position, rotation, one);
}
const position = new Vector3();
const rotation = new Quaternion();
const one = new Vector3(1, 1, 1);
