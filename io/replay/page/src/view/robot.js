// SPDX-License-Identifier: Apache-2.0
// What has a shape: visual shapes, collision shapes, and the highlight of the selected link.
//
// Layers: opaque visuals, translucent visuals, collision shapes, and those with an image, a layer
// each. `visual` shows collision shapes of links that have no visual; `both` makes ghosts of the
// visuals.

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
import { showImage } from './images.js';
import { BodyMatrices, Layer } from './layer.js';
import { collisionGhost, fadedGhost, highlight, visualGhost } from './materials.js';
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

    const plain = visuals.filter((item) => item.image === null);
    const layerOf = (items, material) => Object.assign(new Layer(items, material), { material });
    this.opaque = layerOf(
      plain.filter((item) => item.opaque),
      this.solid,
    );
    this.translucent = layerOf(
      plain.filter((item) => !item.opaque),
      this.clear,
    );
    this.imaged = (run.header.images ?? []).flatMap((_, image) =>
      [true, false].map((opaque) => {
        const items = visuals.filter((item) => item.image === image && item.opaque === opaque);
        const material = standard(opaque ? {} : { transparent: true, opacity: 0.45, depthWrite: false });
        return Object.assign(layerOf(items, material), { image });
      }),
    );
    this.visual = [this.opaque, this.translucent, ...this.imaged];
    this.collision = new Layer(collisions, this.collisionSolid);
    this.layers = [...this.visual, this.collision];
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
      image: piece.image,
    }));
  }

  setMode(mode) {
    this.mode = mode;
    const ghosts = mode === 'both';
    for (const layer of this.visual) {
      layer.mesh.material = ghosts ? this.visualGhost : layer.material;
      layer.filter(() => mode !== 'collision');
    }
    this.collision.mesh.material = ghosts ? this.collisionGhost : this.collisionSolid;
    this.collision.filter((item) => mode !== 'visual' || !this.withVisual.has(item.link));
    for (const layer of this.layers.filter(({ mesh }) => mesh !== this.translucent.mesh)) {
      layer.mesh.castShadow = layer !== this.collision || !ghosts;
      layer.mesh.receiveShadow = !ghosts;
    }
    this.select(this.selected);
  }

  /** Puts the images on; a promise. */
  showImages() {
    return Promise.all(
      this.imaged.map(({ image, material }) => showImage(this.run, image, material)),
    );
  }

  /** From here on translucent, without shadows: as a run beside another is drawn. */
  fade() {
    const material = fadedGhost();
    for (const { mesh } of this.layers) {
      mesh.material = material;
      mesh.castShadow = mesh.receiveShadow = false;
      mesh.renderOrder = 1;
    }
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
