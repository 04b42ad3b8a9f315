// SPDX-License-Identifier: Apache-2.0

// MuJoCo's description of a scene.
//
// A body of MuJoCo needs mass, so a chain of links without mass ends in one body that has all the
// joints of the chain, their axes and anchors turned into the frame of the last link. Links on
// fixed joints become bodies without a joint, which MuJoCo merges (fusestatic).

import { compose, conjugate, identity, inverse, rotate } from './geometry.mjs';

const text = (value) => (Array.isArray(value) ? value.join(' ') : String(value));

function element(tag, attributes, children = []) {
  const list = Object.entries(attributes)
    .filter(([, value]) => value !== undefined)
    .map(([key, value]) => ` ${key}="${text(value)}"`);
  const open = `<${tag}${list.join('')}`;
  return children.length ? `${open}>\n${children.join('\n')}\n</${tag}>` : `${open}/>`;
}

const poseOf = (item) => ({
  p: item.position ?? identity.p,
  q: item.quaternion ?? identity.q,
});

const kTypes = { revolute: 'hinge', prismatic: 'slide', floating: 'free' };

function jointElement(joint, fromBody) {
  const free = joint.type === 'floating';
  return element('joint', {
    name: joint.name,
    type: kTypes[joint.type],
    axis: free ? undefined : rotate(conjugate(fromBody.q), joint.axis),
    pos: free ? undefined : inverse(fromBody).p,
    limited: free ? undefined : String(Boolean(joint.range)),
    range: joint.range,
    damping: joint.damping,
    armature: joint.armature,
    frictionloss: joint.dryFriction,
    stiffness: joint.stiffness,
    springref: joint.springReference,
    margin: joint.margin,
    solreflimit: joint.solref,
    solimplimit: joint.solimp,
    solreffriction: joint.solref,
    solimpfriction: joint.solimp,
  });
}

function geometryElement(g) {
  const sizes = {
    plane: () => [0, 0, 1],
    sphere: () => [g.radius],
    capsule: () => [g.radius, g.halfLength],
    cylinder: () => [g.radius, g.halfLength],
    box: () => g.halfExtents,
  };
  return element('geom', {
    name: g.name,
    type: g.kind,
    size: sizes[g.kind](),
    pos: g.position,
    quat: g.quaternion,
    friction: g.friction,
    condim: g.condim,
    margin: g.margin,
    priority: g.priority,
    solmix: g.solmix,
    solref: g.solref,
    solimp: g.solimp,
  });
}

function inertialElement(link) {
  const [xx, yy, zz, ...products] = link.inertia;
  const isDiagonal = products.every((x) => x === 0);
  return element('inertial', {
    pos: link.com,
    mass: link.mass,
    diaginertia: isDiagonal ? [xx, yy, zz] : undefined,
    fullinertia: isDiagonal ? undefined : link.inertia,
  });
}

class Converter {
  constructor(scene) {
    this.scene = scene;
    this.links = new Map(scene.links.map((link) => [link.name, link]));
    this.sites = new Map(); // link name -> elements
  }

  childJoints(link) {
    return this.scene.joints.filter((joint) => joint.parent === link);
  }

  // What hangs on a link besides its mass and joints.
  contents(link) {
    return [
      ...this.scene.geometries.filter((g) => g.link === link).map(geometryElement),
      ...(this.sites.get(link) ?? []),
      ...this.childJoints(link).map((joint) => this.body(joint)),
    ];
  }

  body(joint) {
    const chain = [{ joint, pose: poseOf(joint) }];
    let link = this.links.get(joint.child);
    if (!link) throw new Error(`joint ${joint.name}: no link ${joint.child}`);
    while (!(link.mass > 0) && joint.type !== 'fixed') {
      const next = this.childJoints(link.name);
      const carries = this.scene.geometries.some((g) => g.link === link.name);
      if (next.length !== 1 || next[0].type === 'fixed' || carries)
        throw new Error(`link ${link.name} has no mass and is not just a step of a chain`);
      chain.push({ joint: next[0], pose: poseOf(next[0]) });
      link = this.links.get(next[0].child);
    }
    // Pose of the body in the frame of each joint's own link, from the last back to the first.
    let fromBody = identity;
    for (let i = chain.length - 1; i >= 0; --i) {
      chain[i].fromBody = fromBody;
      fromBody = compose(chain[i].pose, fromBody);
    }
    const joints = chain
      .filter((step) => step.joint.type !== 'fixed')
      .map((step) => jointElement(step.joint, step.fromBody));
    const mass = link.mass > 0 ? [inertialElement(link)] : [];
    return element('body', { name: link.name, pos: fromBody.p, quat: fromBody.q }, [
      ...joints,
      ...mass,
      ...this.contents(link.name),
    ]);
  }

  equality(e, index) {
    const solver = { solref: e.solref, solimp: e.solimp };
    if (e.kind === 'joint')
      return element('joint', {
        joint1: e.follower,
        joint2: e.leader,
        polycoef: e.polynomial,
        ...solver,
      });
    const site = (side) => {
      const name = `equality_${index}_${side}`;
      const list = this.sites.get(e[`link${side}`]) ?? [];
      list.push(element('site', { name, pos: e[`position${side}`], quat: e[`quaternion${side}`] }));
      this.sites.set(e[`link${side}`], list);
      return name;
    };
    return element(e.kind, { site1: site('A'), site2: site('B'), ...solver });
  }

  model(name, { diagexact, ...attributes }, solver) {
    const flags = diagexact ? { diagexact: 'enable' } : {};
    const equalities = this.scene.equalities.map((e, i) => this.equality(e, i));
    return element('mujoco', { model: name }, [
      element('compiler', {
        angle: 'radian',
        autolimits: 'false',
        inertiafromgeom: 'false',
        fusestatic: 'true',
      }),
      element('option', { ...attributes, ...solver }, [element('flag', { island: 'disable', ...flags })]),
      element('worldbody', {}, this.contents('world')),
      ...(equalities.length ? [element('equality', {}, equalities)] : []),
    ]);
  }
}

// MJCF of a scene; `options` and `solver` are attributes of its <option>.
export function toMjcf(name, scene, options, solver) {
  return new Converter(scene).model(name, options, solver);
}
