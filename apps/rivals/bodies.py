# SPDX-License-Identifier: Apache-2.0
"""What the scenes of the study are made of: rotations, bodies, joints."""
import math

import numpy as np

GRAVITY = 9.81


def turn(axis, angle):
    a = np.asarray(axis, float) / np.linalg.norm(axis)
    K = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K


def quaternion(R):
    """w, x, y, z of a rotation matrix."""
    K = np.array([
        [R[0, 0] - R[1, 1] - R[2, 2], 0, 0, 0],
        [R[1, 0] + R[0, 1], R[1, 1] - R[0, 0] - R[2, 2], 0, 0],
        [R[2, 0] + R[0, 2], R[2, 1] + R[1, 2], R[2, 2] - R[0, 0] - R[1, 1], 0],
        [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], R[0, 0] + R[1, 1] + R[2, 2]]])
    vectors = np.linalg.eigh(K / 3, UPLO="L")[1]
    x, y, z, w = vectors[:, 3]
    return [float(s) for s in (w, x, y, z)] if w >= 0 else [float(-s) for s in (w, x, y, z)]


def shape(kind, size, position=(0, 0, 0), R=np.eye(3)):
    return {"kind": kind, "size": [float(s) for s in size], "position": list(map(float, position)),
            "orientation": quaternion(np.asarray(R))}


def body(name, mass, inertia, position, R=np.eye(3), shapes=(), velocity=(0, 0, 0), spin=(0, 0, 0), force=None):
    """`force` acts at the centre of mass, in the world."""
    made = {"name": name, "mass": float(mass), "inertia": list(map(float, inertia)),
            "position": list(map(float, position)), "orientation": quaternion(np.asarray(R)),
            "velocity": list(map(float, velocity)), "angular_velocity": list(map(float, spin)),
            "shapes": list(shapes)}
    return {**made, "force": list(map(float, force))} if force else made


def box_inertia(mass, half):
    s = [mass * h * h / 3 for h in half]
    return s[1] + s[2], s[0] + s[2], s[0] + s[1]


def box(name, mass, half, position, **more):
    return body(name, mass, box_inertia(mass, half), position, shapes=[shape("box", half)], **more)


def sphere(name, mass, radius, position, **more):
    return body(name, mass, 3 * [0.4 * mass * radius ** 2], position,
                shapes=[shape("sphere", (radius, 0, 0))], **more)


def capsule(name, mass, radius, half, position, **more):
    """Its inertia is that of a cylinder."""
    across = mass * (0.25 * radius ** 2 + half ** 2 / 3)
    return body(name, mass, (across, across, 0.5 * mass * radius ** 2), position,
                shapes=[shape("capsule", (radius, half, 0))], **more)


def joint(kind, parent, child, anchor, axis=(0, 0, 1), force=0.0, limits=None, program=()):
    """`program`: forces, each from a time on (seconds, newtons), after the constant one; of sliders."""
    made = {"kind": kind, "parent": parent, "child": child, "anchor": list(map(float, anchor)),
            "axis": list(map(float, axis)), "force": force, "range": limits}
    return {**made, "program": [list(p) for p in program]} if program else made


def scene(measure, bodies, joints=(), *, duration, sample=0.02, friction=0.5, ground=False,
          collide=False, gravity=(0, 0, -GRAVITY), restitution=0.0, ground_friction=None):
    """`friction` is that of every pair, or of all but those with the ground, which have `ground_friction`."""
    made = {"measure": measure, "gravity": list(map(float, gravity)), "friction": friction,
            "ground": ground, "collide": collide, "duration": duration, "sample": sample,
            "bodies": list(bodies), "joints": list(joints)}
    if restitution:
        made["restitution"] = restitution
    return made if ground_friction is None else {**made, "ground_friction": ground_friction}
