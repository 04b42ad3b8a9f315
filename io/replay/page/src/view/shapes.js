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

/**
 * A BatchedMesh wants the same attributes everywhere: position, normal, colour and an index; and uv
 * where an image is drawn.
 */
function complete(geometry, hasImage = false) {
  if (!hasImage) geometry.deleteAttribute('uv');
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
   * Of a shape: [{geometry, scale, opaque, coloured, image}]. A mesh of which parts are translucent,
   * or have an image, gives several; `opaque` is null where who uses the shape says, `image` where
   * there is none. Empty for planes, which have no size.
   */
  pieces(shape) {
    switch (shape.kind) {
      case 'sphere':
        return [this.#primitive('sphere', [shape.radius, shape.radius, shape.radius])];
      case 'cylinder':
        return [this.#primitive('cylinder', [shape.radius, shape.radius, shape.halfLength])];
      case 'box':
        return [this.#primitive('box', shape.halfExtents)];
      case 'ellipsoid':
        return [this.#primitive('sphere', shape.halfExtents)];
      case 'capsule':
        return [
          { geometry: this.#capsule(shape), scale: [1, 1, 1], opaque: null, coloured: false, image: null },
        ];
      case 'mesh':
        return this.#once(`mesh ${shape.mesh}`, () => this.#mesh(shape.mesh));
      default:
        return [];
    }
  }

  #primitive(kind, scale) {
    const geometry = this.#once(kind, () => complete(PRIMITIVES[kind]()));
    const positive = scale.map((x) => Math.max(x, 1e-6));
    return { geometry, scale: positive, opaque: null, coloured: false, image: null };
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
    if (mesh.parts.length === 0) return [this.#piece({ position, normal }, null)];
    const uv = mesh.uv ? this.run.array(mesh.uv) : null;
    const color = new Float32Array(position.length);
    const kinds = new Map(); // of parts, and their corners
    for (const part of mesh.parts) {
      const image = uv ? (part.image ?? null) : null;
      const opaque = part.rgba[3] >= 1;
      const key = `${image} ${opaque}`;
      if (!kinds.has(key)) kinds.set(key, { image, opaque, corners: [] });
      const { r, g, b } = image === null ? surfaceColor(part.rgba) : { r: 1, g: 1, b: 1 };
      for (let c = 3 * part.first; c < 3 * (part.first + part.count); ++c) {
        kinds.get(key).corners.push(c);
        color.set([r, g, b], 3 * c);
      }
    }
    return [...kinds.values()].map(({ image, opaque, corners }) => {
      const take = (from, size) =>
        Float32Array.from(
          { length: size * corners.length },
          (_, i) => from[size * corners[Math.floor(i / size)] + (i % size)],
        );
      const attributes = { position: take(position, 3), normal: take(normal, 3), color: take(color, 3) };
      if (image !== null) attributes.uv = take(uv, 2);
      return this.#piece(attributes, opaque, image);
    });
  }

  #piece(attributes, opaque, image = null) {
    const geometry = new BufferGeometry();
    for (const [name, array] of Object.entries(attributes))
      geometry.setAttribute(name, new BufferAttribute(array, name === 'uv' ? 2 : 3));
    return {
      geometry: complete(geometry, image !== null),
      scale: [1, 1, 1],
      opaque,
      coloured: 'color' in attributes,
      image,
    };
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
