// SPDX-License-Identifier: Apache-2.0
// Numbers of the selected link at the time shown: pose and velocity of its frame, world axes.

import { element, fixed } from '../app/dom.js';
import { norm, rollPitchYaw } from '../data/transform.js';

const triple = (values, decimals) => values.map((x) => fixed(x, decimals)).join(' ');

export class Inspector {
  constructor(host, run, selection) {
    this.run = run;
    this.selection = selection;
    this.title = element('h2', {}, '');
    this.list = element('dl', { class: 'numbers' });
    this.hint = element(
      'p',
      { class: 'quiet' },
      'Click a link, here or in the view, to read its pose and speed.',
    );
    this.panel = element('div', { hidden: true }, this.title, this.list);
    host.append(this.hint, this.panel);
    this.cells = {};
    for (const [key, name] of [
      ['body', 'Body'],
      ['joint', 'Joint'],
      ['position', 'Position [m]'],
      ['quaternion', 'Quaternion wxyz'],
      ['rpy', 'Roll pitch yaw [°]'],
      ['velocity', 'Velocity [m/s]'],
      ['speed', 'Speed [m/s]'],
      ['angular', 'Angular vel. [rad/s]'],
      ['turn', 'Angular speed [rad/s]'],
    ]) {
      this.cells[key] = element('dd');
      this.list.append(element('dt', {}, name), this.cells[key]);
    }
  }

  update(time, poses) {
    const { link, body } = this.selection;
    this.hint.hidden = link !== null;
    this.panel.hidden = link === null;
    if (!link) return;
    const { position, quaternion } = this.run.linkPose(link, poses);
    const { linear, angular } = this.run.linkVelocity(link, time, poses);
    const show = (key, text) => {
      if (this.cells[key].textContent === text) return;
      this.cells[key].textContent = text;
      if (key === 'body' || key === 'joint') this.cells[key].title = text;
    };
    this.title.textContent = this.title.title = link.name;
    show('body', body.name === link.name ? 'itself' : body.name);
    show('joint', body.joint ? `${body.joint}, ${body.kind}` : 'fixed to the world');
    show('position', triple(position, 4));
    show('quaternion', triple(quaternion, 4));
    show(
      'rpy',
      triple(
        rollPitchYaw(quaternion).map((x) => (x * 180) / Math.PI),
        2,
      ),
    );
    show('velocity', triple(linear, 3));
    show('angular', triple(angular, 3));
    show('speed', fixed(norm(linear), 3));
    show('turn', fixed(norm(angular), 3));
  }
}
