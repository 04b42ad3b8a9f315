// SPDX-License-Identifier: Apache-2.0
// Another run beside this one, translucent: where its bodies are at the same time. Before its start
// and after its end it stands still.

import { Robot } from './robot.js';

export class Beside {
  /** `origin`: what the scene is relative to. */
  constructor(run, origin) {
    this.run = run;
    this.poses = new Float64Array(7 * run.bodies.length);
    this.robot = new Robot(run);
    this.robot.fade();
    this.group = this.robot.group;
    this.group.position.fromArray(run.header.origin.map((x, i) => x - origin[i]));
  }

  moveTo(time) {
    this.run.posesAt(Math.min(this.run.end, Math.max(this.run.start, time)), this.poses);
    this.robot.place(this.poses);
  }

  /** Where it is in the scene. */
  bounds() {
    return this.robot.bounds().translate(this.group.position);
  }

  dispose() {
    for (const { mesh } of this.robot.layers) mesh.dispose();
  }
}
