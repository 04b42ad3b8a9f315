// SPDX-License-Identifier: Apache-2.0
// What has a shape: visual shapes, collision shapes, and the highlight of the selected link.
//
// Three layers: opaque visuals, translucent visuals, collision shapes. `visual` shows collision
// shapes of links that have no visual; `both` makes ghosts of the visuals.

import {
  Box3,
  Color,
  DoubleSide,
  Group,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  Sphere,
  Vector3,
} from 'three';
import { BodyMatrices, Layer } from './layer.js';
import { collisionGhost, highlight, visualGhost } from './materials.js';
import { localMatrix, Shapes, surfaceColor } from './shapes.js';

const MOVING = ['#7f97ad', '#93a9bc', '#6d8aa5', '#a4b4c2'];
const FIXED = '#b5aea2';

export class Robot {
  constructor(run) {
    this.run = run;
    this.group = new Group();
    this.matrices = new BodyMatrices(run.bodies.length);
    this.shapes = new Shapes(run);
    this.withVisual = new Set();

    const visuals = [];
    for (const visual of run.header.visuals) {
      const pieces = this.#items(visual, (piece) =>
        piece.coloured ? new Color(1, 1, 1) : surfaceColor(visual.rgba),
      );
      for (const item of pieces) item.opaque ??= visual.rgba[3] >= 1;
      if (pieces.length > 0) this.withVisual.add(visual.link);
      visuals.push(...pieces);
    }
    const collisions = run.header.geometries.flatMap((geometry) =>
      this.#items(
        geometry,
        () => new Color(geometry.body === 0 ? FIXED : MOVING[geometry.body % MOVING.length]),
      ),
    );

    const standard = (options) =>
      new MeshStandardMaterial({
        roughness: 0.62,
        metalness: 0.06,
        vertexColors: true,
        side: DoubleSide,
        ...options,
      });
    this.solid = standard({});
    this.clear = standard({ transparent: true, opacity: 0.45, depthWrite: false });
    this.visualGhost = visualGhost();
    this.collisionSolid = standard({ roughness: 0.75, metalness: 0 });
    this.collisionGhost = collisionGhost();

    this.opaque = new Layer(
      visuals.filter((item) => item.opaque),
      this.solid,
    );
    this.translucent = new Layer(
      visuals.filter((item) => !item.opaque),
      this.clear,
    );
    this.collision = new Layer(collisions, this.collisionSolid);
    this.layers = [this.opaque, this.translucent, this.collision];
    this.group.add(...this.layers.map((layer) => layer.mesh));

    this.highlight = new Group();
    this.highlightMaterial = highlight();
    this.group.add(this.highlight);
    this.selected = null;
    this.hasVisuals = visuals.length > 0;
    this.setMode('visual');
  }

  #items(source, color) {
    return this.shapes.pieces(source.shape).map((piece) => ({
      geometry: piece.geometry,
      local: localMatrix(source, piece.scale),
      body: source.body,
      link: source.link,
      color: color(piece),
      opaque: piece.opaque,
    }));
  }

  setMode(mode) {
    this.mode = mode;
    const ghosts = mode === 'both';
    this.opaque.mesh.material = ghosts ? this.visualGhost : this.solid;
    this.translucent.mesh.material = ghosts ? this.visualGhost : this.clear;
    this.collision.mesh.material = ghosts ? this.collisionGhost : this.collisionSolid;
    this.opaque.filter(() => mode !== 'collision');
    this.translucent.filter(() => mode !== 'collision');
    this.collision.filter((item) => mode !== 'visual' || !this.withVisual.has(item.link));
    for (const layer of [this.opaque, this.collision]) {
      layer.mesh.castShadow = layer === this.opaque || !ghosts;
      layer.mesh.receiveShadow = !ghosts;
    }
    this.select(this.selected);
  }

  place(poses) {
    const matrices = this.matrices.update(poses);
    for (const layer of this.layers) layer.place(matrices);
    for (const mesh of this.highlight.children)
      mesh.matrix.multiplyMatrices(matrices[mesh.userData.body], mesh.userData.local);
  }

  /** Highlights a link, or none. */
  select(link) {
    this.selected = link;
    this.highlight.clear();
    for (const item of this.itemsOf(link)) {
      const mesh = new Mesh(item.geometry, this.highlightMaterial);
      mesh.matrixAutoUpdate = false;
      mesh.userData = item;
      mesh.matrix.multiplyMatrices(this.matrices.of[item.body], item.local);
      this.highlight.add(mesh);
    }
  }

  /** The shapes of a link that can be seen. */
  itemsOf(link) {
    return this.layers.flatMap((layer) =>
      layer.items.filter((item) => item.visible && item.link === link),
    );
  }

  /** The nearest shape that the ray meets. */
  hit(raycaster) {
    const hits = this.layers.map((layer) => layer.hit(raycaster)).filter((hit) => hit !== null);
    return hits.sort((a, b) => a.distance - b.distance)[0] ?? null;
  }

  /** A box around all that moves, as it is now, and around its pedestal, but not a whole hall. */
  bounds() {
    const all = this.layers.flatMap((layer) => layer.items);
    const moving = this.boundsOf(all.filter((item) => item.body !== 0));
    const fixed = this.boundsOf(all.filter((item) => item.body === 0));
    const size = (box) => box.getSize(new Vector3()).length();
    if (moving.isEmpty() || (!fixed.isEmpty() && size(fixed) < 2 * size(moving)))
      moving.union(fixed);
    if (moving.isEmpty()) moving.set(new Vector3(-0.5, -0.5, 0), new Vector3(0.5, 0.5, 1));
    return moving;
  }

  /** A box around some shapes. */
  boundsOf(items) {
    const box = new Box3();
    const one = new Box3();
    const matrix = new Matrix4();
    for (const item of items) {
      if (!item.geometry.boundingBox) item.geometry.computeBoundingBox();
      matrix.multiplyMatrices(this.matrices.of[item.body], item.local);
      one.copy(item.geometry.boundingBox).applyMatrix4(matrix);
      if (Number.isFinite(one.min.x)) box.union(one);
    }
    return box;
  }

  boundingSphere() {
    return this.bounds().getBoundingSphere(new Sphere());
  }
}
