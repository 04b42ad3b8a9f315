// SPDX-License-Identifier: Apache-2.0
// What is drawn, read back from the scene graph and from the plots, never from the run: a test
// compares it with what the simulator logged.
//
// All in the world; the run's origin, which the scene is relative to, is added here.

import { Box3, Color, Matrix4, Vector3 } from 'three';

/**
 * {plots, shapes, beside, grids, arrows, metresPerNewton, com, cop, goals}; without a view only the
 * plots.
 */
export function drawn(stage, plots, origin) {
  const curves = plots?.drawn() ?? [];
  if (!stage) return { plots: curves };
  stage.scene.updateMatrixWorld(true);
  const offset = new Vector3(...origin);
  const place = (object) =>
    isSeen(object) ? object.getWorldPosition(new Vector3()).add(offset).toArray() : null;
  const { marks, contacts, robot } = stage;
  return {
    plots: curves,
    shapes: robot.layers.flatMap((layer) => shapesOf(layer, offset)),
    beside: stage.beside?.robot.layers.flatMap((layer) => shapesOf(layer, offset)) ?? null,
    grids: stage.grounds.length,
    arrows: arrowsOf(contacts.forces, offset),
    metresPerNewton: contacts.metresPerNewton,
    com: place(marks.comBall),
    cop: place(marks.cop),
    goals: marks.goalMarks.map((goal) => ({ point: place(goal.dot), target: place(goal.ball) })),
  };
}

/** Whether an object and all that holds it are visible. */
function isSeen(object) {
  for (let o = object; o; o = o.parent) if (!o.visible) return false;
  return true;
}

/** Of each visible shape: its link, middle, half axes (columns) and colour in sRGB. */
function shapesOf({ mesh, items }, offset) {
  if (!isSeen(mesh)) return [];
  return items
    .filter(({ instance }) => mesh.getVisibleAt(instance))
    .map(({ instance, link }) => {
      const matrix = mesh.getMatrixAt(instance, new Matrix4()).premultiply(mesh.matrixWorld);
      const box = mesh.getBoundingBoxAt(mesh.getGeometryIdAt(instance), new Box3());
      const half = box.getSize(new Vector3()).multiplyScalar(0.5);
      const axes = [new Vector3(), new Vector3(), new Vector3()];
      matrix.extractBasis(...axes);
      return {
        link,
        middle: box.getCenter(new Vector3()).applyMatrix4(matrix).add(offset).toArray(),
        halfAxes: axes.map((axis, k) => axis.multiplyScalar(half.getComponent(k)).toArray()),
        color: mesh.getColorAt(instance, new Color()).getRGB({}, 'srgb'),
      };
    });
}

/** Of each arrow: where its shaft begins, and from there to the tip of its head. */
function arrowsOf({ shafts, heads, group }, offset) {
  const [shaft] = shafts.meshes;
  const [head] = heads.meshes;
  if (!isSeen(shaft) || !isSeen(head)) return [];
  const matrix = new Matrix4();
  return Array.from({ length: shaft.count }, (_, i) => {
    shaft.getMatrixAt(i, matrix);
    const base = new Vector3().applyMatrix4(matrix.premultiply(group.matrixWorld));
    head.getMatrixAt(i, matrix);
    const tip = new Vector3(0, 0, 1).applyMatrix4(matrix.premultiply(group.matrixWorld));
    return { base: base.clone().add(offset).toArray(), vector: tip.sub(base).toArray() };
  });
}
