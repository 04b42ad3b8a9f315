// SPDX-License-Identifier: Apache-2.0

// A scene in MuJoCo: states, trajectories, and all that one evaluation gives, as plain data.

import { add, cross, scale } from './geometry.mjs';

// Converged to rounding. Islands would only change the order of sums.
export const kSolver = {
  solver: 'Newton',
  tolerance: 0,
  iterations: 200,
  ls_iterations: 100,
  ls_tolerance: 1e-6,
  jacobian: 'dense',
};

// What the solver may leave of the balance of forces, relative to the largest force.
const kBalance = 1e-9;

const list = (view, count = view.length, from = 0) => Array.from(view.subarray(from, from + count));

function rowsOf(values, rows, columns) {
  return Array.from({ length: rows }, (_, i) => list(values, columns, i * columns));
}

export class Simulation {
  constructor(mujoco, mjcf) {
    this.mujoco = mujoco;
    this.model = mujoco.MjModel.from_xml_string(mjcf);
    this.data = new mujoco.MjData(this.model);
  }
  delete() {
    this.data.delete();
    this.model.delete();
  }

  nameOf(kind, index) {
    return this.mujoco.mj_id2name(this.model, this.mujoco.mjtObj[kind].value, index);
  }

  // Names of the joints that own the degrees of freedom, in the order of v.
  dofs() {
    return list(this.model.dof_jntid).map((joint) => this.nameOf('mjOBJ_JOINT', joint));
  }
  initialPosition() {
    return list(this.model.qpos0);
  }

  set({ q, v, force }) {
    const { model, data, mujoco } = this;
    mujoco.mj_resetData(model, data);
    if (q.length !== model.nq || v.length !== model.nv || force.length !== model.nv)
      throw new Error(`state of ${q.length}, ${v.length}, ${force.length} numbers; expected ${model.nq}, ${model.nv}, ${model.nv}`);
    data.qpos.set(q);
    data.qvel.set(v);
    data.qfrc_applied.set(force);
  }

  // Applied force with which the bias of that state does nothing at scalar joints.
  holdingForce(state) {
    this.set(state);
    this.mujoco.mj_forward(this.model, this.data);
    const free = this.mujoco.mjtJoint.mjJNT_FREE.value;
    const isFree = list(this.model.dof_jntid).map((joint) => this.model.jnt_type[joint] === free);
    return state.force.map((f, i) => (isFree[i] ? f : f + this.data.qfrc_bias[i]));
  }

  massMatrix() {
    const buffer = new this.mujoco.DoubleBuffer(this.model.nv * this.model.nv);
    this.mujoco.mj_fullM(this.model, this.data, buffer);
    const matrix = rowsOf(buffer.GetView(), this.model.nv, this.model.nv);
    buffer.delete();
    return matrix;
  }

  contacts() {
    const { data } = this;
    return Array.from({ length: data.ncon }, (_, i) => {
      const contact = data.contact.get(i);
      const plain = {
        geometries: list(contact.geom).map((g) => this.nameOf('mjOBJ_GEOM', g)),
        position: list(contact.pos),
        frame: list(contact.frame),
        distance: contact.dist,
        condim: contact.dim,
        friction: list(contact.friction),
        row: contact.efc_address,
      };
      contact.delete();
      return plain;
    });
  }

  rows() {
    const { data, model, mujoco } = this;
    const kinds = Object.entries(mujoco.mjtConstraint)
      .filter(([key]) => key.startsWith('mjCNSTR_'))
      .map(([key, item]) => [item.value, key.slice('mjCNSTR_'.length).toLowerCase()]);
    const kindOf = new Map(kinds);
    const J = rowsOf(data.efc_J, data.nefc, model.nv);
    return J.map((row, i) => ({
      kind: kindOf.get(data.efc_type[i]),
      id: data.efc_id[i],
      J: row,
      D: data.efc_D[i],
      R: data.efc_R[i],
      reference: data.efc_aref[i],
      force: data.efc_force[i],
      position: data.efc_pos[i],
      margin: data.efc_margin[i],
    }));
  }

  // The largest component of M a − (smooth + constraint forces), relative to the largest force.
  imbalance(matrix) {
    const { data } = this;
    const acceleration = list(data.qacc);
    let worst = 0;
    let largest = 1;
    matrix.forEach((row, i) => {
      const inertial = row.reduce((sum, m, j) => sum + m * acceleration[j], 0);
      const force = data.qfrc_smooth[i] + data.qfrc_constraint[i];
      worst = Math.max(worst, Math.abs(inertial - force));
      largest = Math.max(largest, Math.abs(force), Math.abs(data.qfrc_smooth[i]));
    });
    return worst / largest;
  }

  // Wrenches about the origins of links; MuJoCo wants them about the centre of mass.
  applyWrenches(wrenches) {
    const { mujoco, model, data } = this;
    for (const { link, force, moment } of wrenches) {
      const body = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY.value, link);
      if (body < 0) throw new Error(`a wrench on ${link}`);
      const arm = add(list(data.xpos, 3, 3 * body), scale(-1, list(data.xipos, 3, 3 * body)));
      data.xfrc_applied.set([...force, ...add(moment, cross(arm, force))], 6 * body);
    }
  }

  // Energy [J]; centre of mass and momentum of all that moves, angular about the centre of mass.
  totals() {
    const { mujoco, model, data } = this;
    mujoco.mj_energyPos(model, data);
    mujoco.mj_energyVel(model, data);
    mujoco.mj_subtreeVel(model, data);
    const [potential, kinetic] = list(data.energy);
    return {
      mass: model.body_subtreemass[0],
      potential,
      kinetic,
      centre_of_mass: list(data.subtree_com, 3),
      momentum: scale(model.body_subtreemass[0], list(data.subtree_linvel, 3)),
      angular_momentum: list(data.subtree_angmom, 3),
    };
  }

  // Everything of one state; the inverse is taken at qacc + `offset`.
  evaluate(state, offset) {
    const { mujoco, model, data } = this;
    this.set(state);
    mujoco.mj_forward(model, data);
    if (state.wrenches) {
      this.applyWrenches(state.wrenches);
      mujoco.mj_forward(model, data);
    }
    const matrix = this.massMatrix();
    const imbalance = this.imbalance(matrix);
    if (!(imbalance < kBalance)) throw new Error(`forces balance to ${imbalance} only`);
    const record = {
      q: state.q,
      v: state.v,
      force: state.force,
      wrenches: state.wrenches,
      totals: this.totals(),
      mass_matrix: matrix,
      bias: list(data.qfrc_bias),
      smooth_acceleration: list(data.qacc_smooth),
      acceleration: list(data.qacc),
      contacts: this.contacts(),
      rows: this.rows(),
    };
    data.qacc.set(record.acceleration.map((a, i) => a + offset[i]));
    record.inverse = { acceleration: list(data.qacc) };
    mujoco.mj_inverse(model, data);
    record.inverse.force = list(data.qfrc_inverse);
    return record;
  }

  // The acceleration alone.
  accelerationAt(state) {
    const { mujoco, model, data } = this;
    this.set(state);
    mujoco.mj_forward(model, data);
    const imbalance = this.imbalance(this.massMatrix());
    if (!(imbalance < kBalance)) throw new Error(`forces balance to ${imbalance} only`);
    return { contacts: data.ncon, rows: data.nefc, acceleration: list(data.qacc) };
  }

  // Samples of a free run, `every` [s].
  trajectory(state, integrator, timestep, duration, every) {
    const { mujoco, model, data } = this;
    const kinds = { Euler: 'mjINT_EULER', RK4: 'mjINT_RK4', implicit: 'mjINT_IMPLICIT', implicitfast: 'mjINT_IMPLICITFAST' };
    const before = { integrator: model.opt.integrator, timestep: model.opt.timestep };
    model.opt.integrator = mujoco.mjtIntegrator[kinds[integrator]].value;
    model.opt.timestep = timestep;
    const samples = { integrator, timestep, every, q: [], v: [] };
    const stride = Math.round(every / timestep);
    const steps = Math.round(duration / timestep);
    this.set(state);
    for (let step = 0; step <= steps; ++step) {
      if (step % stride === 0) {
        samples.q.push(list(data.qpos));
        samples.v.push(list(data.qvel));
      }
      mujoco.mj_step(model, data);
    }
    Object.assign(model.opt, before);
    return samples;
  }
}
