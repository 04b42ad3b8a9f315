// SPDX-License-Identifier: Apache-2.0
// The camera: orbit, pan and zoom by pointer; presets; frame all; follow a point.

import { PerspectiveCamera, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

// From where each preset looks, x forward, y left, z up.
export const PRESETS = {
  home: [1.0, -0.95, 0.5],
  front: [1, 0, 0.06],
  side: [0, -1, 0.06],
  top: [0, -0.0015, 1],
};

export class Camera {
  constructor(canvas, size) {
    this.camera = new PerspectiveCamera(35, 1, 0.01, 100);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(...PRESETS.home);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.14;
    this.controls.zoomToCursor = true;
    this.controls.minDistance = 0.02 * size;
    this.controls.maxDistance = 60 * size;
    this.size = size;
    this.clear = 1;
    this.followed = null;
    this.shift = new Vector3();
    this.chosen = false;
    this.controls.addEventListener('start', () => (this.chosen = true));
  }

  /** The upper edge is under the toolbar, so the middle of the view is a little lower. */
  resize(width, height, covered) {
    this.camera.aspect = width / height;
    this.clear = Math.max(0.5, 1 - covered / height);
    this.camera.setViewOffset(width, height, 0, -0.5 * (1 - this.clear) * height, width, height);
  }

  /** Looks at a sphere so that it fills the view, from a preset or from where the camera is. */
  frame({ center, radius }, preset = null) {
    const direction = preset
      ? new Vector3(...PRESETS[preset])
      : this.camera.position.clone().sub(this.controls.target);
    const half = (this.camera.fov * Math.PI) / 360;
    const narrow = Math.atan(Math.tan(half) * Math.min(this.clear, this.camera.aspect));
    const distance = radius / Math.sin(narrow);
    this.controls.target.copy(center);
    this.camera.position.copy(center).addScaledVector(direction.normalize(), distance);
    this.controls.update();
    this.followed?.copy(center);
  }

  /** Brings a point to the middle of the view. */
  lookAt(point) {
    this.chosen = true;
    this.camera.position.add(point).sub(this.controls.target);
    this.controls.target.copy(point);
  }

  /** From here on the camera moves with a point; null stops that. */
  follow(point) {
    this.followed = point ? point.clone() : null;
  }

  /** The followed point is now at `point`. */
  carry(point) {
    if (!this.followed || !point) return;
    this.shift.copy(point).sub(this.followed);
    this.followed.copy(point);
    this.controls.target.add(this.shift);
    this.camera.position.add(this.shift);
  }

  /** Before each picture. The near plane stays as far away as it can, for depth is finite. */
  update() {
    this.controls.update();
    const distance = this.camera.position.distanceTo(this.controls.target);
    const near = Math.max(0.01 * distance, 0.004 * this.size);
    const far = distance + 80 * this.size;
    if (near !== this.camera.near || far !== this.camera.far) {
      this.camera.near = near;
      this.camera.far = far;
      this.camera.updateProjectionMatrix();
    }
    this.camera.updateMatrixWorld();
  }
}
