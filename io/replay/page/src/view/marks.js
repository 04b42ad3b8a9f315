// SPDX-License-Identifier: Apache-2.0
// Marks that are points: centre of mass and its projection, centre of pressure, goals, the frame
// of the selected link and the path that it takes.

import {
  BufferAttribute,
  BufferGeometry,
  Color,
  CylinderGeometry,
  Group,
  Line,
  LineBasicMaterial,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  RingGeometry,
  SphereGeometry,
  Vector3,
} from 'three';
import { placed, rotate } from '../data/transform.js';
import { Arrows } from './arrows.js';
import { Ground } from './ground.js';
import { markMaterials } from './materials.js';

export const COLORS = {
  com: '#e8c300',
  cop: '#b04fd8',
  goal: '#12a36d',
  path: '#3a8fdd',
  axes: ['#e0453a', '#4aa832', '#3a78e0'],
};

/** A geometry drawn plain where seen, faint where hidden. */
function marked(geometry, color, options) {
  const { plain, hidden } = markMaterials(color, options);
  const group = new Group();
  const faint = new Mesh(geometry, hidden);
  faint.renderOrder = 3;
  group.add(new Mesh(geometry, plain), faint);
  return group;
}

/** A ball in alternate octants, as the sign of a centre of mass. */
function centerOfMassBall(radius) {
  const geometry = new SphereGeometry(radius, 32, 24).toNonIndexed();
  const at = geometry.getAttribute('position');
  const colors = new Float32Array(3 * at.count);
  const [bright, dark] = [new Color(COLORS.com), new Color('#20242a')];
  for (let v = 0; v < at.count; v += 3) {
    const middle = [0, 1, 2].map(
      (k) => at.getComponent(v, k) + at.getComponent(v + 1, k) + at.getComponent(v + 2, k),
    );
    const color = middle[0] * middle[1] * middle[2] > 0 ? bright : dark;
    for (let c = v; c < v + 3; ++c) color.toArray(colors, 3 * c);
  }
  geometry.setAttribute('color', new BufferAttribute(colors, 3));
  const group = marked(geometry, '#ffffff', { vertexColors: true });
  group.children[0].material.emissiveIntensity = 0.12;
  return group;
}

const level = { polygonOffset: true, polygonOffsetFactor: -4, polygonOffsetUnits: -4, side: 2 };
const across = (length, radius) =>
  new CylinderGeometry(radius, radius, length, 10).rotateX(Math.PI / 2).translate(0, 0, length / 2);

/** Turns a bar of length 1 along z so that it goes from a to b. */
function span(bar, a, b) {
  bar.position.copy(a);
  bar.lookAt(b);
  bar.scale.set(1, 1, a.distanceTo(b));
}

class Goal {
  constructor(size) {
    const radius = 0.035 * size;
    this.radius = radius;
    this.group = new Group();
    this.ball = new Mesh(
      new SphereGeometry(radius, 32, 20),
      new MeshLambertMaterial({
        color: COLORS.goal,
        emissive: COLORS.goal,
        emissiveIntensity: 0.4,
        transparent: true,
        opacity: 0.38,
        depthWrite: false,
        toneMapped: false,
      }),
    );
    this.ring = marked(new RingGeometry(1.3 * radius, 1.5 * radius, 48), COLORS.goal, { side: 2 });
    this.dot = marked(new SphereGeometry(0.28 * radius, 16, 12), COLORS.goal);
    this.line = marked(across(1, 0.09 * radius), COLORS.goal);
    this.group.add(this.ball, this.ring, this.dot, this.line);
    this.target = new Vector3();
    this.point = new Vector3();
  }

  update(point, target, camera) {
    this.group.visible = target !== null;
    if (!this.group.visible) return;
    this.target.fromArray(target);
    this.ball.position.copy(this.target);
    this.ring.position.copy(this.target);
    this.ring.quaternion.copy(camera.quaternion);
    this.dot.visible = this.line.visible = point !== null;
    if (point === null) return;
    this.point.fromArray(point);
    this.dot.position.copy(this.point);
    span(this.line, this.point, this.target);
  }
}

export class Marks {
  constructor(run, size, planes) {
    this.run = run;
    this.planes = planes;
    this.size = size;
    this.com = new Group();
    this.comBall = centerOfMassBall(0.028 * size);
    this.comRing = marked(new RingGeometry(0.02 * size, 0.028 * size, 40), COLORS.com, level);
    this.comLine = marked(across(1, 0.0025 * size), COLORS.com);
    this.com.add(this.comBall, this.comRing, this.comLine);
    this.cop = marked(new RingGeometry(0, 0.017 * size, 32), COLORS.cop, level);
    this.goals = new Group();
    this.goalMarks = run.header.goals.map(() => new Goal(size));
    for (const goal of this.goalMarks) this.goals.add(goal.group);
    this.axes = new Group();
    this.axisArrows = COLORS.axes.map((color) => new Arrows(1, color, 0.005 * size));
    this.axes.add(...this.axisArrows.map((arrow) => arrow.group));
    this.path = new Line(
      new BufferGeometry(),
      new LineBasicMaterial({
        color: COLORS.path,
        transparent: true,
        opacity: 0.8,
        toneMapped: false,
        depthTest: false,
      }),
    );
    this.path.frustumCulled = false;
    this.path.renderOrder = 2;
    this.group = new Group();
    this.group.add(this.com, this.cop, this.goals, this.axes, this.path);
    this.shown = { com: true, cop: true, goals: true, axes: true, path: true };
    this.link = null;
    this.show({});
  }

  show(shown) {
    Object.assign(this.shown, shown);
    this.goals.visible = this.shown.goals;
    this.axes.visible = this.shown.axes && this.link !== null;
    this.path.visible = this.shown.path && this.link !== null && this.link.body !== 0;
  }

  select(link) {
    this.link = link;
    this.show({});
    if (!link || link.body === 0) return;
    const { run } = this;
    const points = new Float32Array(3 * run.frames);
    const size = 7 * run.bodies.length;
    for (let i = 0; i < run.frames; ++i)
      points.set(placed(run.pose.subarray(i * size, (i + 1) * size), link.body, link).p, 3 * i);
    this.path.geometry.dispose();
    this.path.geometry = new BufferGeometry();
    this.path.geometry.setAttribute('position', new BufferAttribute(points, 3));
  }

  /** Where the goals want their points to be. */
  targets(time) {
    const count = this.goalMarks.length;
    return this.goalMarks
      .map((_, g) => this.run.vectorAt(this.run.goalTarget, time, count, g))
      .filter((target) => target !== null)
      .map((target) => new Vector3(...target));
  }

  /** The nearest mark of a place there, {mark, point}, or null. */
  hit(raycaster) {
    let nearest = null;
    if (!this.shown.goals) return null;
    this.goalMarks.forEach((goal, mark) => {
      if (!goal.group.visible) return;
      const [hit] = raycaster.intersectObject(goal.ball);
      if (hit && !(nearest?.distance <= hit.distance))
        nearest = { mark, point: goal.target.clone(), distance: hit.distance };
    });
    return nearest;
  }

  update(time, poses, camera) {
    const { run, shown } = this;
    const ground = Ground.levelHeight(this.planes, poses);
    const com = run.vectorAt(run.com, time);
    this.com.visible = shown.com && com !== null;
    if (com) {
      this.comBall.position.fromArray(com);
      const height = ground === null ? 0 : com[2] - ground;
      const above = height > 0 && height < 20 * this.size;
      this.comRing.visible = this.comLine.visible = above;
      if (above) {
        this.comRing.position.set(com[0], com[1], ground);
        span(this.comLine, this.comRing.position, this.comBall.position);
      }
    }
    const cop = run.vectorAt(run.cop, time);
    this.cop.visible = shown.cop && cop !== null;
    if (cop) this.cop.position.fromArray(cop);
    const count = this.goalMarks.length;
    this.goalMarks.forEach((goal, g) =>
      goal.update(
        run.vectorAt(run.goalPoint, time, count, g),
        run.vectorAt(run.goalTarget, time, count, g),
        camera,
      ),
    );
    if (this.link) this.#placeAxes(poses);
  }

  #placeAxes(poses) {
    const { p, q } = placed(poses, this.link.body, this.link);
    this.axisArrows.forEach((arrow, k) => {
      const axis = rotate(
        q,
        [0, 1, 2].map((i) => (i === k ? 0.16 * this.size : 0)),
      );
      arrow.begin();
      arrow.add(...p, ...axis);
      arrow.end();
    });
  }
}
