// SPDX-License-Identifier: Apache-2.0
// Materials whose edges stand out: the more a surface turns away, the less one sees through it.

import { Color, FrontSide, GreaterDepth, MeshLambertMaterial, MeshBasicMaterial } from 'three';

/** Opacity from `opacity` where the surface faces the camera to `rim` where it turns away. */
function withRim(material, rim, power) {
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
      '#include <opaque_fragment>',
      `float facing = abs(dot(normalize(vViewPosition), normalize(normal)));
       float turned = pow(1.0 - facing, ${power.toFixed(1)});
       diffuseColor.a = mix(diffuseColor.a, ${rim.toFixed(3)}, turned);
       #include <opaque_fragment>`,
    );
  };
  material.customProgramCacheKey = () => `rim ${rim} ${power}`;
  return material;
}

const seeThrough = { transparent: true, depthWrite: false, side: FrontSide };

export const visualGhost = () =>
  withRim(new MeshLambertMaterial({ ...seeThrough, vertexColors: true, opacity: 0.22 }), 0.55, 2);

export const collisionGhost = () =>
  withRim(new MeshLambertMaterial({ ...seeThrough, color: '#3aa9d8', opacity: 0.16 }), 0.85, 2.5);

/** Of a run beside another: behind it where both are in the same place. */
export const fadedGhost = () =>
  withRim(
    new MeshLambertMaterial({
      ...seeThrough,
      vertexColors: true,
      opacity: 0.3,
      polygonOffset: true,
      polygonOffsetFactor: 2,
      polygonOffsetUnits: 2,
    }),
    0.6,
    2,
  );

/** Laid over the shapes of the selected link, seen through what is before them. */
export const highlight = () =>
  withRim(
    new MeshLambertMaterial({
      ...seeThrough,
      color: '#000000',
      emissive: '#1e90ff',
      emissiveIntensity: 1,
      opacity: 0.22,
      polygonOffset: true,
      polygonOffsetFactor: -2,
      polygonOffsetUnits: -2,
    }),
    0.95,
    2,
  );

/**
 * The pair of materials of a mark: plain where nothing is before it, faint where something is, so
 * that a force inside a foot is still seen.
 */
export function markMaterials(color, options = {}) {
  const common = { color: new Color(color), toneMapped: false, ...options };
  const plain = new MeshLambertMaterial({
    ...common,
    emissive: new Color(color),
    emissiveIntensity: 0.35,
  });
  const hidden = new MeshBasicMaterial({
    ...common,
    transparent: true,
    opacity: 0.33,
    depthWrite: false,
    depthFunc: GreaterDepth,
  });
  return { plain, hidden };
}
