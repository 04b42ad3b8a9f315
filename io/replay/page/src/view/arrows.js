// SPDX-License-Identifier: Apache-2.0
// Many arrows, or many dots, in a few draw calls. Memory is taken once; add() only writes numbers.

import { ConeGeometry, CylinderGeometry, Group, InstancedMesh, SphereGeometry } from 'three';
import { markMaterials } from './materials.js';

/** Instances of one geometry, drawn plain where seen and faint where hidden. */
class Instances {
  constructor(geometry, capacity, { plain, hidden }) {
    this.seen = new InstancedMesh(geometry, plain, Math.max(1, capacity));
    this.faint = new InstancedMesh(geometry, hidden, Math.max(1, capacity));
    this.faint.instanceMatrix = this.seen.instanceMatrix;
    this.array = this.seen.instanceMatrix.array;
    this.meshes = [this.seen, this.faint];
    for (const mesh of this.meshes) mesh.frustumCulled = false;
    this.faint.renderOrder = 3;
    this.count = 0;
  }

  /** Columns: x axis, y axis, z axis, position; the axes carry the scale. */
  add(xx, xy, xz, yx, yy, yz, zx, zy, zz, px, py, pz) {
    const m = this.array;
    const o = 16 * this.count++;
    m[o] = xx;
    m[o + 1] = xy;
    m[o + 2] = xz;
    m[o + 3] = 0;
    m[o + 4] = yx;
    m[o + 5] = yy;
    m[o + 6] = yz;
    m[o + 7] = 0;
    m[o + 8] = zx;
    m[o + 9] = zy;
    m[o + 10] = zz;
    m[o + 11] = 0;
    m[o + 12] = px;
    m[o + 13] = py;
    m[o + 14] = pz;
    m[o + 15] = 1;
  }

  end() {
    for (const mesh of this.meshes) {
      mesh.count = this.count;
      mesh.visible = this.count > 0;
    }
    this.seen.instanceMatrix.needsUpdate = true;
  }
}

export class Arrows {
  /** `width`: radius of the shaft [m]. */
  constructor(capacity, color, width) {
    const materials = markMaterials(color);
    const shaft = new CylinderGeometry(1, 1, 1, 12).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    const head = new ConeGeometry(1, 1, 20).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    this.shafts = new Instances(shaft, capacity, materials);
    this.heads = new Instances(head, capacity, materials);
    this.width = width;
    this.group = new Group();
    this.group.add(...this.shafts.meshes, ...this.heads.meshes);
  }

  begin() {
    this.shafts.count = 0;
    this.heads.count = 0;
  }

  /** From p along f, as long as f is. */
  add(px, py, pz, fx, fy, fz) {
    const length = Math.hypot(fx, fy, fz);
    if (!(length > 1e-9)) return;
    const [zx, zy, zz] = [fx / length, fy / length, fz / length];
    // Two directions across: the first is that of the world's axis which f has least of.
    let [ax, ay, az] = Math.abs(zx) < 0.6 ? [1, 0, 0] : [0, 1, 0];
    const dot = ax * zx + ay * zy + az * zz;
    ax -= dot * zx;
    ay -= dot * zy;
    az -= dot * zz;
    const across = Math.hypot(ax, ay, az);
    ax /= across;
    ay /= across;
    az /= across;
    const [bx, by, bz] = [zy * az - zz * ay, zz * ax - zx * az, zx * ay - zy * ax];
    const head = Math.min(7 * this.width, 0.5 * length);
    const w = Math.min(this.width, 0.14 * length);
    const h = 2.6 * w;
    const s = length - head;
    this.shafts.add(
      w * ax,
      w * ay,
      w * az,
      w * bx,
      w * by,
      w * bz,
      s * zx,
      s * zy,
      s * zz,
      px,
      py,
      pz,
    );
    this.heads.add(
      h * ax,
      h * ay,
      h * az,
      h * bx,
      h * by,
      h * bz,
      head * zx,
      head * zy,
      head * zz,
      px + s * zx,
      py + s * zy,
      pz + s * zz,
    );
  }

  end() {
    this.shafts.end();
    this.heads.end();
  }
}

export class Dots {
  constructor(capacity, color, radius) {
    this.dots = new Instances(new SphereGeometry(1, 16, 12), capacity, markMaterials(color));
    this.radius = radius;
    this.group = new Group();
    this.group.add(...this.dots.meshes);
  }

  begin() {
    this.dots.count = 0;
  }

  add(x, y, z) {
    const r = this.radius;
    this.dots.add(r, 0, 0, 0, r, 0, 0, 0, r, x, y, z);
  }

  end() {
    this.dots.end();
  }
}
