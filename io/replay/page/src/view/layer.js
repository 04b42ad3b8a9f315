// SPDX-License-Identifier: Apache-2.0
// Many shapes in one draw call: a BatchedMesh whose instances follow their bodies.

import { BatchedMesh, Matrix4 } from 'three';
import { bodyMatrix } from './shapes.js';

export class Layer {
  /** `items`: {geometry, local (matrix in the body), body, link, color}. */
  constructor(items, material) {
    this.items = items;
    const geometries = [...new Set(items.map((item) => item.geometry))];
    const total = (count) => geometries.reduce((sum, g) => sum + count(g), 0);
    this.mesh = new BatchedMesh(
      Math.max(1, items.length),
      Math.max(
        1,
        total((g) => g.getAttribute('position').count),
      ),
      Math.max(
        1,
        total((g) => g.index.count),
      ),
      material,
    );
    this.mesh.perObjectFrustumCulled = false;
    this.mesh.sortObjects = false;
    this.mesh.frustumCulled = false;
    const ids = new Map(geometries.map((g) => [g, this.mesh.addGeometry(g)]));
    for (const item of items) {
      item.instance = this.mesh.addInstance(ids.get(item.geometry));
      item.visible = true;
      this.mesh.setColorAt(item.instance, item.color);
    }
    this.scratch = new Matrix4();
  }

  /** Puts every shape where its body is. */
  place(matrices) {
    for (const item of this.items) {
      this.scratch.multiplyMatrices(matrices[item.body], item.local);
      this.mesh.setMatrixAt(item.instance, this.scratch);
    }
  }

  /** Shows the items that `accept` says. */
  filter(accept) {
    let any = false;
    for (const item of this.items) {
      item.visible = accept(item);
      any ||= item.visible;
      this.mesh.setVisibleAt(item.instance, item.visible);
    }
    this.mesh.visible = any;
  }

  /** The nearest item that the ray meets: {item, distance, point} or null. */
  hit(raycaster) {
    if (!this.mesh.visible) return null;
    const [first] = raycaster.intersectObject(this.mesh, false);
    if (!first) return null;
    const item = this.items.find(({ instance }) => instance === first.batchId);
    return { item, distance: first.distance, point: first.point };
  }
}

/** Matrices of all bodies for their poses. */
export class BodyMatrices {
  constructor(count) {
    this.of = Array.from({ length: count }, () => new Matrix4());
  }

  update(poses) {
    this.of.forEach((matrix, i) => bodyMatrix(poses, i, matrix));
    return this.of;
  }
}
