// SPDX-License-Identifier: Apache-2.0
// The 3D view: renderer, lights, and everything that is drawn; picking. Emits `picked`, `hovered`.
//
// It draws only when something has changed.

import {
  AmbientLight,
  DirectionalLight,
  HemisphereLight,
  NeutralToneMapping,
  PCFShadowMap,
  Raycaster,
  Scene,
  Sphere,
  Vector2,
  Vector3,
  WebGLRenderer,
} from 'three';
import { Emitter } from '../app/emitter.js';
import { placed } from '../data/transform.js';
import { Beside } from './beside.js';
import { Camera } from './camera.js';
import { Contacts } from './contacts.js';
import { Ground, gridCell } from './ground.js';
import { Marks } from './marks.js';
import { Robot } from './robot.js';

const THEMES = {
  light: {
    ground: '#f4f2ee',
    line: '#c6c2ba',
    shadow: 0.32,
    sky: 1.75,
    key: 2.7,
    rim: 0.7,
    bounce: '#d9d2c6',
  },
  dark: {
    ground: '#24282e',
    line: '#464d57',
    shadow: 0.55,
    sky: 1.7,
    key: 2.8,
    rim: 1.0,
    bounce: '#3a3f48',
  },
};

export class Stage extends Emitter {
  constructor(run, canvas) {
    super();
    this.run = run;
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.toneMapping = NeutralToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.scene = new Scene();
    this.poses = run.posesAt(run.start, new Float64Array(7 * run.bodies.length));
    this.time = run.start;

    this.robot = new Robot(run);
    this.robot.place(this.poses);
    const { radius } = this.robot.boundingSphere();
    this.size = 2 * radius;
    this.planes = planesOf(run);
    this.cell = gridCell(this.size);
    this.grounds = this.planes.map((plane) => new Ground(plane, this.cell));
    this.beside = null;
    this.contacts = new Contacts(run, this.size);
    this.marks = new Marks(run, this.size, this.planes);
    for (const part of [
      this.robot.group,
      this.contacts.group,
      this.marks.group,
      ...this.grounds.map((g) => g.mesh),
    ])
      this.scene.add(part);
    this.#addLights();
    this.camera = new Camera(canvas, this.size);
    this.raycaster = new Raycaster();
    this.following = null;
    this.pictures = 0;
    this.fitted = []; // width, height and what is covered, as the camera has them
    this.covered = 0; // of the view, at its top, by what lies over it [pixels]
    this.coarse = false;
    this.pace = 0;
    this.changed = true;
    this.#listen();
    this.moveTo(run.start);
  }

  #addLights() {
    this.sky = new HemisphereLight('#ffffff', '#d9d2c6', 2);
    this.key = new DirectionalLight('#fff6ea', 2.5);
    this.rim = new DirectionalLight('#dfeaff', 0.8);
    this.ambient = new AmbientLight('#ffffff', 0.15);
    this.key.castShadow = true;
    this.#setShadowSize(2048);
    this.key.shadow.radius = 5;
    this.key.shadow.bias = -0.0004;
    this.key.shadow.normalBias = 0.006 * this.size;
    const reach = 1.25 * this.size;
    const { camera } = this.key.shadow;
    [camera.left, camera.right, camera.bottom, camera.top] = [-reach, reach, -reach, reach];
    [camera.near, camera.far] = [0.1 * this.size, 8 * this.size];
    this.scene.add(this.sky, this.ambient, this.key, this.key.target, this.rim, this.rim.target);
  }

  #setShadowSize(pixels) {
    const { shadow } = this.key;
    shadow.mapSize.set(pixels, pixels);
    shadow.map?.dispose();
    shadow.map = null;
  }

  #listen() {
    this.camera.controls.addEventListener('change', () => (this.changed = true));
    let down = null;
    this.canvas.addEventListener('pointerdown', (event) => (down = [event.clientX, event.clientY]));
    this.canvas.addEventListener('pointerup', (event) => {
      const still = down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4;
      if (still && event.button === 0) this.emit('picked', this.pick(event.clientX, event.clientY));
      down = null;
    });
    this.canvas.addEventListener('dblclick', (event) => {
      const hit = this.hitAt(event.clientX, event.clientY);
      if (hit) this.camera.lookAt(hit.point);
    });
    this.canvas.addEventListener('pointermove', (event) => {
      if (event.buttons === 0) this.hover = [event.clientX, event.clientY];
    });
    this.canvas.addEventListener('pointerleave', () => this.emit('hovered', null));
    this.canvas.addEventListener('webglcontextrestored', () => (this.changed = true));
  }

  /** The name of the link at a place of the window, or null. */
  pick(x, y) {
    return this.hitAt(x, y)?.item.link ?? null;
  }

  /** The nearest shape there, {item, point}, or null. */
  hitAt(x, y) {
    this.#aim(x, y);
    return this.robot.hit(this.raycaster);
  }

  /** The nearest mark of a goal's place there, {mark, point}, or null. */
  markAt(x, y) {
    this.#aim(x, y);
    return this.marks.hit(this.raycaster);
  }

  /** The point of a plane that is seen there, or null. */
  pointOn(plane, x, y) {
    this.#aim(x, y);
    return this.raycaster.ray.intersectPlane(plane, new Vector3());
  }

  #aim(x, y) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const place = new Vector2(((x - left) / width) * 2 - 1, 1 - ((y - top) / height) * 2);
    this.raycaster.setFromCamera(place, this.camera.camera);
  }

  moveTo(time) {
    this.time = time;
    this.run.posesAt(time, this.poses);
    this.robot.place(this.poses);
    this.beside?.moveTo(time);
    this.contacts.update(time, this.poses);
    this.camera?.carry(this.#followedPoint());
    this.changed = true;
  }

  #followedPoint() {
    if (!this.following) return null;
    if (this.following === 'com') {
      const com = this.run.vectorAt(this.run.com, this.time);
      return com && new Vector3(...com);
    }
    const link = this.run.linkByName.get(this.following);
    return new Vector3(...placed(this.poses, link.body, link).p);
  }

  /** Puts the run's images on its surfaces; a promise. */
  async showImages() {
    await this.robot.showImages();
    this.changed = true;
  }

  /** Draws another run beside this one, or none. */
  showBeside(run) {
    if (this.beside) {
      this.scene.remove(this.beside.group);
      this.beside.dispose();
    }
    this.beside = run ? new Beside(run, this.run.header.origin) : null;
    if (!run) {
      this.changed = true;
      return;
    }
    this.scene.add(this.beside.group);
    this.moveTo(this.time);
    if (!this.camera.chosen) this.frameAll();
  }

  /** `what`: 'com', the name of a link, or null. */
  follow(what) {
    this.following = what;
    this.camera.follow(this.#followedPoint());
  }

  select(name) {
    const link = name ? (this.run.linkByName.get(name) ?? null) : null;
    this.robot.select(link?.name ?? null);
    this.marks.select(link);
    this.changed = true;
  }

  frameAll(preset = null) {
    const box = this.robot.bounds();
    if (this.beside) box.union(this.beside.bounds());
    for (const target of this.marks.targets(this.time)) box.expandByPoint(target);
    this.camera.frame(box.getBoundingSphere(new Sphere()), preset);
    this.camera.chosen = false;
    this.changed = true;
  }

  setMode(mode) {
    this.robot.setMode(mode);
    this.changed = true;
  }

  setTheme(name) {
    const theme = THEMES[name];
    for (const ground of this.grounds) ground.setTheme(theme);
    this.sky.intensity = theme.sky;
    this.sky.groundColor.set(theme.bounce);
    this.key.intensity = theme.key;
    this.rim.intensity = theme.rim;
    this.changed = true;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    const size = [width, height, this.covered];
    const isOther = size.some((pixels, i) => pixels !== this.fitted[i]);
    this.fitted = size;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio) * (this.coarse ? 0.5 : 1));
    this.renderer.setSize(width, height, false);
    this.camera.resize(width, height, this.covered);
    if (isOther && !this.camera.chosen) this.frameAll();
    // The resized canvas is empty, and is shown before the next turn of the clock.
    this.changed = true;
    this.draw();
  }

  /**
   * While playing: how long the last picture took [ms]; null at rest. A slow machine gets coarser
   * ones until it rests.
   */
  pacing(milliseconds) {
    this.pace = milliseconds === null ? 0 : 0.7 * this.pace + 0.3 * Math.min(milliseconds, 500);
    const coarse = milliseconds !== null && (this.coarse || this.pace > 80);
    if (coarse === this.coarse) return;
    this.coarse = coarse;
    this.#setShadowSize(coarse ? 512 : 2048);
    this.resize();
  }

  /** Where a link is seen: window coordinates of the middle of its nearest shape that is shown. */
  screenPosition(name) {
    const items = this.robot.itemsOf(name);
    const { camera } = this.camera;
    let nearest = null;
    for (const item of items) {
      const middle = this.robot.boundsOf([item]).getCenter(new Vector3());
      const distance = middle.distanceTo(camera.position);
      if (!nearest || distance < nearest.distance) nearest = { middle, distance };
    }
    const link = this.run.linkByName.get(name);
    if (!nearest && !link) return null;
    return this.#onScreen(
      nearest?.middle ?? new Vector3(...placed(this.poses, link.body, link).p),
    );
  }

  /** The same of the mark of a goal's place. */
  markPosition(mark) {
    const goal = this.marks.goalMarks[mark];
    return goal?.group.visible ? this.#onScreen(goal.target.clone()) : null;
  }

  #onScreen(point) {
    point.project(this.camera.camera);
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    return [left + ((point.x + 1) / 2) * width, top + ((1 - point.y) / 2) * height];
  }

  /** Draws if something has changed. */
  draw() {
    this.camera.update();
    if (this.hover) {
      this.emit('hovered', this.pick(...this.hover), this.hover);
      this.hover = null;
    }
    if (!this.changed) return;
    this.changed = false;
    const { target } = this.camera.controls;
    const distance = this.camera.camera.position.distanceTo(target);
    const center = this.robot.boundingSphere().center;
    this.key.target.position.copy(center);
    this.key.position.copy(center).add(new Vector3(1.5, -1.1, 3.2).multiplyScalar(this.size));
    this.rim.target.position.copy(center);
    this.rim.position.copy(center).add(new Vector3(-2.5, 2, 1.2).multiplyScalar(this.size));
    this.grounds.forEach((ground) =>
      ground.update(
        this.robot.matrices.of[ground.plane.body],
        target,
        Math.max(7 * this.size, 2.2 * distance),
      ),
    );
    this.marks.update(this.time, this.poses, this.camera.camera);
    this.renderer.render(this.scene, this.camera.camera);
    this.pictures += 1;
  }
}

/** The planes of the run; drawn ones only where no plane collides. */
function planesOf(run) {
  const isPlane = (item) => item.shape.kind === 'plane';
  const colliding = run.header.geometries.filter(isPlane);
  return colliding.length > 0 ? colliding : run.header.visuals.filter(isPlane);
}
