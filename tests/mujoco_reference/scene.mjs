// SPDX-License-Identifier: Apache-2.0

// A scene as both engines read it: links, joints, geometries, equalities, as plain data.
//
// What is left out has the default of the engine that reads it, and the two must agree. Units are
// m, kg, rad, N; quaternions have w first. A link without a mass is an intermediate one of a joint
// of several dofs. Inertias are central, in link axes: [xx, yy, zz, xy, xz, yz].
//
//   link      {name, mass, com, inertia}
//   joint     {name, type, parent, child, position, quaternion, axis, range, damping, armature,
//              dryFriction, stiffness, springReference, margin, solref, solimp}
//             type: fixed, revolute, prismatic, floating (from `world`)
//   geometry  {name, link, kind, radius, halfLength, halfExtents, position, quaternion,
//              friction: [slide, spin, roll], condim, margin, priority, solmix, solref, solimp}
//   equality  {kind: joint, follower, leader, polynomial} or
//             {kind: connect or weld, linkA, positionA, quaternionA, linkB, …B}, solref, solimp

export class Scene {
  links = [];
  joints = [];
  geometries = [];
  equalities = [];

  link(name, mass = 0, inertia = [0, 0, 0, 0, 0, 0], com = [0, 0, 0]) {
    this.links.push(mass > 0 ? { name, mass, com, inertia } : { name });
    return this;
  }
  joint(name, type, parent, child, more = {}) {
    this.joints.push({ name, type, parent, child, ...more });
    return this;
  }
  geometry(name, link, shape, more = {}) {
    this.geometries.push({ name, link, ...shape, ...more });
    return this;
  }
  equality(kind, more) {
    this.equalities.push({ kind, ...more });
    return this;
  }
  // A half-space below z = 0, or below the plane of a pose.
  ground(material = {}) {
    return this.geometry('ground', 'world', { kind: 'plane' }, material);
  }
  // A homogeneous solid that floats.
  freeBody(name, mass, shape, material = {}) {
    return this.link(name, mass, solidInertia(mass, shape))
      .joint(`${name}_joint`, 'floating', 'world', name)
      .geometry(`${name}_shape`, name, shape, material);
  }
  // A homogeneous solid on a joint, its centre at `com` of the link.
  solid(name, mass, shape, com) {
    return this.link(name, mass, solidInertia(mass, shape), com);
  }
}

export const sphere = (radius) => ({ kind: 'sphere', radius });
export const capsule = (radius, halfLength) => ({ kind: 'capsule', radius, halfLength });
export const cylinder = (radius, halfLength) => ({ kind: 'cylinder', radius, halfLength });
export const box = (x, y, z) => ({ kind: 'box', halfExtents: [x, y, z] });

// Central inertia of a homogeneous solid. A capsule counts as the cylinder that it contains.
export function solidInertia(mass, shape) {
  const { radius: r, halfLength: h } = shape;
  switch (shape.kind) {
    case 'sphere':
      return [0.4 * mass * r * r, 0.4 * mass * r * r, 0.4 * mass * r * r, 0, 0, 0];
    case 'box': {
      const [x, y, z] = shape.halfExtents.map((e) => (e * e * mass) / 3);
      return [y + z, x + z, x + y, 0, 0, 0];
    }
    case 'capsule':
    case 'cylinder': {
      const across = mass * (r * r / 4 + (h * h) / 3);
      return [across, across, (mass * r * r) / 2, 0, 0, 0];
    }
    default:
      throw new Error(`no inertia of a ${shape.kind}`);
  }
}
