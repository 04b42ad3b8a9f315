// SPDX-License-Identifier: Apache-2.0
// MuJoCo from npm. Settings as those of mujoco.cpp; the description is written anew here, so that one
// slip is not in both.
import {bodyOf, carrierOf, conjugate, directionIn, forceAt, jointSpeed, minus, pointIn, times, turned} from './npm_vectors.mjs';

const text = (v) => v.join(' ');

// A restitution: an impact of thirty steps, on a spring and damper of that e (solref in its direct form), less what gravity takes.
function solref(scene, h) {
  const e = scene.restitution, omega = Math.PI / (30 * h);
  if (!e) return '';
  const s = scene.bodies[0].shapes[0], under = s.kind === 'box' ? s.size[2] : s.size[0], g = Math.hypot(...scene.gravity);
  const pull = g / (omega * Math.sqrt(2 * g * (scene.bodies[0].position[2] - under)));
  let low = 0, high = 1;
  for (let i = 0; i < 60; ++i) {
    const zeta = 0.5 * (low + high), root = Math.sqrt(1 - zeta * zeta);
    if (Math.exp(-2 * zeta / root * Math.atan2(root, zeta)) - 3.5 * zeta * pull > e) low = zeta;
    else high = zeta;
  }
  return ` solref="${-omega * omega} ${-2 * low * omega}"`;
}

function bodyXml(scene, i, h) {
  const b = scene.bodies[i], j = carrierOf(scene, i), parent = bodyOf(scene, j ? j.parent : -1);
  let x = `<body name="${b.name}" pos="${text(pointIn(parent, b.position))}" quat="${text(times(conjugate(parent.orientation), b.orientation))}">`;
  if (!j) x += '<freejoint/>';
  else {
    const type = {hinge: 'hinge', slider: 'slide', ball: 'ball'}[j.kind];
    x += `<joint type="${type}" pos="${text(pointIn(b, j.anchor))}"`;
    if (j.kind !== 'ball') x += ` axis="${text(directionIn(b, j.axis))}"`;
    x += j.range ? ` limited="true" range="${text(j.range)}"/>` : '/>';
  }
  x += `<inertial pos="0 0 0" mass="${b.mass}" diaginertia="${text(b.inertia)}"/>`;
  for (const s of b.shapes)
    x += `<geom type="${s.kind}" size="${text(s.size)}" pos="${text(s.position)}" quat="${text(s.orientation)}" ` +
      `friction="${scene.friction} 0.005 0.0001"${solref(scene, h)} contype="${scene.collide ? 3 : 0}" conaffinity="${scene.collide ? 3 : 1}"/>`;
  scene.bodies.forEach((_, k) => {
    if (carrierOf(scene, k)?.parent === i) x += bodyXml(scene, k, h);
  });
  return x + '</body>';
}

function mjcf(scene, h, settings) {
  const {integrator = 'Euler', cone = 'pyramidal', noslip = 0, impratio = 1} = settings;
  let x = '<mujoco><compiler angle="radian" balanceinertia="false" boundmass="0" boundinertia="0"/>' +
    `<option timestep="${h}" gravity="${text(scene.gravity)}" integrator="${integrator}" cone="${cone}" ` +
    `noslip_iterations="${noslip}" impratio="${impratio}"/><size memory="200M"/><worldbody>`;
  if (scene.ground) x += `<geom type="plane" size="0 0 1" friction="${scene.ground_friction ?? scene.friction} 0.005 0.0001" priority="1"${solref(scene, h)} contype="1" conaffinity="1"/>`;
  scene.bodies.forEach((_, i) => {
    if ((carrierOf(scene, i)?.parent ?? -1) < 0) x += bodyXml(scene, i, h);
  });
  x += '</worldbody><equality>';
  for (const j of scene.joints.filter((k) => k.kind === 'tie')) {
    const c = scene.bodies[j.child];
    x += `<connect body1="${c.name}" anchor="${text(pointIn(c, j.anchor))}"` +
      (j.parent < 0 ? '/>' : ` body2="${scene.bodies[j.parent].name}"/>`);
  }
  return x + '</equality></mujoco>';
}

export async function makeMujoco(packages, scene, h, settings) {
  const M = await (await import(`${packages}/@mujoco/mujoco/mujoco.js`)).default();
  const m = M.MjModel.from_xml_string(mjcf(scene, h, settings)), d = new M.MjData(m);
  const forces = [], bodies = scene.bodies.map((b) => M.mj_name2id(m, M.mjtObj.mjOBJ_BODY.value, b.name));
  scene.bodies.forEach((b, i) => {
    const v = m.jnt_dofadr[m.body_jntadr[bodies[i]]], j = carrierOf(scene, i);
    const spin = turned(conjugate(b.orientation), b.angular_velocity);
    if (!j || j.kind === 'ball') [...(j ? [] : b.velocity), ...spin].forEach((x, k) => (d.qvel[v + k] = x));
    else {
      d.qvel[v] = jointSpeed(scene, j);
      forces.push([v, j]);
    }
  });
  scene.bodies.forEach((b, i) => (b.force ?? []).forEach((x, k) => (d.xfrc_applied[6 * bodies[i] + k] = x)));
  M.mj_forward(m, d);
  const bad = [M.mjtWarning.mjWARN_BADQPOS, M.mjtWarning.mjWARN_BADQVEL, M.mjtWarning.mjWARN_BADQACC].map((w) => w.value);
  return {
    mass: () => M.mj_getTotalmass(m),
    kineticEnergy: () => (M.mj_energyVel(m, d), d.energy[1]),
    step() {
      for (const [v, j] of forces) d.qfrc_applied[v] = forceAt(j, d.time);
      M.mj_step(m, d);
      return bad.every((w) => d.warning.get(w).number === 0);
    },
    state() {
      M.mj_kinematics(m, d);
      M.mj_comPos(m, d);
      M.mj_comVel(m, d);
      const at = (array, n, b) => Array.from(array.subarray(n * b, n * b + n));
      return bodies.map((b) => {
        const position = at(d.xipos, 3, b), about = at(d.subtree_com, 3, m.body_rootid[b]);
        const [wx, wy, wz, ...v] = at(d.cvel, 6, b), angularVelocity = [wx, wy, wz], r = minus(position, about);
        const velocity = [v[0] + wy * r[2] - wz * r[1], v[1] + wz * r[0] - wx * r[2], v[2] + wx * r[1] - wy * r[0]];
        return {position, orientation: times(at(d.xquat, 4, b), at(m.body_iquat, 4, b)), velocity, angularVelocity};
      });
    }
  };
}
