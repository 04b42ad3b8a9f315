// SPDX-License-Identifier: Apache-2.0
// A plane as a grid that fades out around what one looks at, with the shadows on it.
//
// Lines every `cell` and stronger ones every ten cells, drawn by their distance in pixels, so that
// they neither flicker nor vanish; seen from below the plane is not drawn.

import { Color, FrontSide, Mesh, PlaneGeometry, ShadowMaterial, Vector2, Vector3 } from 'three';
import { localMatrix } from './shapes.js';

const VERTEX = `
varying vec2 vLocal;
varying vec2 vOffset;
uniform vec2 uCenter;
uniform float uRadius;
void main() {
  vOffset = position.xy;
  vLocal = uCenter + uRadius * position.xy;
`;

const FRAGMENT = `
varying vec2 vLocal;
varying vec2 vOffset;
uniform float uCell;
uniform vec3 uGround;
uniform vec3 uLine;
uniform float uShadow;
float lines(vec2 p, float cell, float width) {
  vec2 q = p / cell;
  vec2 w = fwidth(q);
  vec2 d = abs(fract(q - 0.5) - 0.5) / max(w, 1e-6);
  vec2 line = clamp(width - d + 0.5, 0.0, 1.0) * clamp(1.4 - 3.5 * w, 0.0, 1.0);
  return max(line.x, line.y);
}
`;

const COLOR = `
  float fade = 1.0 - smoothstep(0.25, 1.0, length(vOffset));
  float thin = 0.35 * lines(vLocal, uCell, 0.5) * (1.0 - smoothstep(0.1, 0.5, length(vOffset)));
  float thick = lines(vLocal, 10.0 * uCell, 0.7);
  vec3 base = mix(uGround, uLine, max(thin, thick));
  base = mix(base, vec3(0.0), uShadow * (1.0 - getShadowMask()));
  gl_FragColor = vec4(base, fade);
`;

/** 0.01, 0.1, 1, … m: a sixth of the size of what is seen, or less. */
export const gridCell = (size) => 10 ** Math.floor(Math.log10(size / 6));

export class Ground {
  constructor(plane, cell) {
    this.plane = plane;
    this.uniforms = {
      uCenter: { value: new Vector2() },
      uRadius: { value: 1 },
      uCell: { value: cell },
      uGround: { value: new Color() },
      uLine: { value: new Color() },
      uShadow: { value: 0.3 },
    };
    const material = new ShadowMaterial({ side: FrontSide, depthWrite: false, toneMapped: false });
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.uniforms);
      shader.vertexShader = shader.vertexShader.replace('void main() {', VERTEX);
      shader.fragmentShader = shader.fragmentShader
        .replace('void main() {', `${FRAGMENT}\nvoid main() {`)
        .replace(/gl_FragColor = vec4\([^;]*;/, COLOR);
    };
    this.mesh = new Mesh(new PlaneGeometry(2, 2), material);
    this.mesh.receiveShadow = true;
    this.mesh.matrixAutoUpdate = false;
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = -1;
    this.local = localMatrix(plane);
    this.center = new Vector3();
  }

  setTheme({ ground, line, shadow }) {
    this.uniforms.uGround.value.set(ground);
    this.uniforms.uLine.value.set(line);
    this.uniforms.uShadow.value = shadow;
  }

  /** Follows its body, and lies around the point `focus` as far as `radius`. */
  update(bodyMatrix, focus, radius) {
    const { matrix } = this.mesh;
    matrix.multiplyMatrices(bodyMatrix, this.local);
    this.center.copy(focus).applyMatrix4(matrix.clone().invert());
    this.uniforms.uCenter.value.set(this.center.x, this.center.y);
    this.uniforms.uRadius.value = radius;
    matrix.multiply(
      localMatrix({ p: [this.center.x, this.center.y, 0], q: [1, 0, 0, 0] }, [radius, radius, 1]),
    );
    this.mesh.matrixWorldNeedsUpdate = true;
  }

  /** Height under a point where the plane is level, else null. */
  static levelHeight(planes, poses) {
    for (const plane of planes) {
      if (plane.body !== 0) continue;
      const [w, x, y] = plane.q;
      if (Math.abs(x) + Math.abs(y) < 1e-9 && Math.abs(w) >= 0) return poses[2] + plane.p[2];
    }
    return null;
  }
}
