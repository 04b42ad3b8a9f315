// SPDX-License-Identifier: Apache-2.0
// The mouse or a finger on a link: drags the point that it took hold of, pushes or turns the body;
// on the mark of a goal: moves the place that is sought.
//
// The point moves in the plane through it that faces the camera. A push is as strong as its arrow is
// long; with the length of the robot it is the robot's weight.

import { Group, Plane, Vector3 } from 'three';
import { conjugate, placed, rotate, subtract } from '../data/transform.js';
import { Arrows } from '../view/arrows.js';

const PUSH_COLOR = '#d6336c';

export class Handle {
  constructor(run, link, stage, selection, settings) {
    this.run = run;
    this.link = link;
    this.stage = stage;
    this.selection = selection;
    this.settings = settings;
    this.held = null;
    this.arrow = new Arrows(1, PUSH_COLOR, 0.008 * stage.size);
    this.group = new Group();
    this.group.add(this.arrow.group);
    stage.scene.add(this.group);
    this.#drawArrow(null);
    // Before the canvas hears of it, so that the camera stays where it is.
    const view = stage.canvas.parentElement;
    view.addEventListener('pointerdown', (event) => this.#down(event), true);
    view.addEventListener('pointermove', (event) => this.#move(event), true);
    for (const name of ['pointerup', 'pointercancel'])
      view.addEventListener(name, (event) => this.#up(event), true);
    link.on('frame', () => this.#follow());
    link.on('writes', (writes) => {
      if (!writes) this.#end();
    });
  }

  /** What a press does now: 'drag', 'push' or 'turn'. */
  #action(event) {
    if (event.shiftKey) return 'push';
    if (event.ctrlKey || event.metaKey) return 'turn';
    return this.settings.get('action');
  }

  #down(event) {
    if (this.held) {
      // A second finger belongs to the first one's drag.
      if (event.target === this.stage.canvas) event.stopPropagation();
      return;
    }
    if (event.target !== this.stage.canvas || event.button !== 0 || !this.link.writes) return;
    const taken = this.#takenAt(event);
    if (!taken) return;
    event.stopPropagation();
    event.preventDefault();
    this.stage.canvas.focus({ preventScroll: true });
    this.stage.canvas.parentElement.setPointerCapture(event.pointerId);
    const normal = this.stage.camera.camera.getWorldDirection(new Vector3());
    this.held = {
      pointer: event.pointerId,
      start: [event.clientX, event.clientY],
      plane: new Plane().setFromNormalAndCoplanarPoint(normal, taken.at),
      target: taken.at.toArray(),
      moved: false,
      ...taken,
    };
    this.stage.emit('hovered', null);
  }

  /** What a press takes hold of: a goal's place, or a point of a link. */
  #takenAt(event) {
    const { clientX, clientY } = event;
    const action = this.#action(event);
    const mark = action === 'drag' ? this.stage.markAt(clientX, clientY) : null;
    if (mark) return { action: 'target', goal: this.run.header.goals[mark.mark].name, at: mark.point };
    const hit = this.stage.hitAt(clientX, clientY);
    const link = hit && this.run.linkByName.get(hit.item.link);
    if (!link || link.body === 0) return null;
    const { p, q } = placed(this.stage.poses, link.body, link);
    return { action, link, point: rotate(conjugate(q), subtract(hit.point.toArray(), p)), at: hit.point };
  }

  #move(event) {
    const { held } = this;
    if (!held || event.pointerId !== held.pointer) return;
    event.stopPropagation();
    if (!held.moved) {
      const [x, y] = held.start;
      if (Math.hypot(event.clientX - x, event.clientY - y) < 4) return;
      held.moved = true;
      if (held.link) this.selection.select(held.link.name);
      if (held.action === 'drag') this.#grab();
    }
    const target = this.stage.pointOn(held.plane, event.clientX, event.clientY);
    if (!target) return;
    held.target = target.toArray();
    const place = this.#inWorld(held.target);
    if (held.action === 'target') this.link.move({ target: { goal: held.goal, place } });
    else if (held.action === 'drag') this.link.move({ move: { target: place } });
    else this.#push();
  }

  #inWorld(point) {
    return point.map((x, i) => x + this.run.header.origin[i]);
  }

  #grab() {
    const { link, point, target } = this.held;
    const duration = this.settings.get('jerkTime');
    this.link.tell({
      grab: {
        link: link.name,
        point,
        target: this.#inWorld(target),
        ...(duration > 0 ? { duration } : {}),
      },
    });
  }

  /** Where the held point is now. */
  #pointNow() {
    const { link, point } = this.held;
    return placed(this.stage.poses, link.body, { p: this.#onBody(link, point), q: link.q }).p;
  }

  #onBody(link, point) {
    return rotate(link.q, point).map((x, i) => x + link.p[i]);
  }

  #push() {
    const { link, point, action, target } = this.held;
    const arm = subtract(target, this.#pointNow());
    const strength = this.run.live.weight / this.stage.size;
    const vector = arm.map((x) => strength * x);
    const torque = { torque: vector.map((x) => 0.3 * this.stage.size * x) };
    this.link.tell({
      push: { link: link.name, point, ...(action === 'push' ? { force: vector } : torque) },
    });
    this.#drawArrow(arm);
  }

  #drawArrow(arm) {
    this.arrow.begin();
    if (arm && Math.hypot(...arm) > 1e-6) this.arrow.add(...this.#pointNow(), ...arm);
    this.arrow.end();
    this.stage.changed = true;
  }

  #pushes({ action }) {
    return action === 'push' || action === 'turn';
  }

  /** The arrow stays with the body. */
  #follow() {
    const { held } = this;
    if (held?.moved && this.#pushes(held))
      this.#drawArrow(subtract(held.target, this.#pointNow()));
  }

  #up(event) {
    const { held } = this;
    if (!held || event.pointerId !== held.pointer) return;
    event.stopPropagation();
    if (!held.moved && held.link) this.selection.select(held.link.name);
    this.#end();
  }

  #end() {
    const { held } = this;
    this.held = null;
    if (!held?.moved) return;
    this.link.sendMove();
    if (this.#pushes(held)) {
      this.#drawArrow(null);
      this.link.tell({ let_go: {} });
    } else if (held.action === 'drag') {
      this.link.tell(this.settings.get('pins') ? { pin: {} } : { release: {} });
    }
  }
}
