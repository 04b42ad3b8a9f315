# SPDX-License-Identifier: Apache-2.0
"""Scenes of what bounces, screws and walks. Nothing is fed back: forces are given beforehand."""
import math

import numpy as np

from bodies import GRAVITY, body, box, box_inertia, joint, scene, shape, sphere, turn

RESTITUTIONS = (0.8, 0.5)


def bounce(kind, restitution):
    """A ball, or a box that lies flat in the air, falls by 1 m. It is long enough for three bounces."""
    start = (0, 0, 1.1)
    falling = sphere("ball", 1, 0.1, start) if kind == "ball" else box("box", 1, (0.1, 0.1, 0.1), start)
    return scene("bounce", [falling], duration=3.0, sample=0.002, ground=True, restitution=restitution)


# ---- A nut ---------------------------------------------------------------------------------------

PLATES, RADIUS, RISE = 36, 0.05, 0.2  # plates a turn, radius where the balls run [m], slope of the thread


def thread(start, i):
    """Plate i of one of three threads, which start at 0°, 120° and 240° at the same height: a point of its upper face where
    a ball runs, and its axes: outwards, up the thread, normal."""
    around = 2 * math.pi * i / PLATES
    R = turn((0, 0, 1), around + 2 * math.pi * start / 3) @ turn((1, 0, 0), math.atan(RISE))
    return R @ [RADIUS, 0, 0] + [0, 0, RADIUS * RISE * around], R


def nut(friction, duration):
    """A nut of 2 kg on a post with three threads of flat plates; a ball of the nut lies on each. It locks itself where
    friction is above the slope of the thread, 0.2, and else runs down."""
    ball, thick, foot, base = 0.005, 0.003, 0.05, 0.1
    post = [shape("box", (0.1, 0.1, 0.02), (0, 0, 0.02 - foot)), shape("capsule", (0.04, 0.05, 0), (0, 0, 0.1 - foot))]
    for start in range(3):
        for i in range(-14, 4):
            at, R = thread(start, i)
            post.append(shape("box", (0.009, 0.0052, thick), at + R @ [-0.003, 0, -thick] + [0, 0, base - foot], R))
    centres = [at + R @ [0, 0, ball] + [0, 0, base] for at, R in (thread(start, 0) for start in range(3))]
    middle = np.array([0, 0, centres[0][2]])
    parts = [shape("sphere", (ball, 0, 0), c - middle) for c in centres]
    for k in range(6):  # the ring around, apart from the threads
        R = turn((0, 0, 1), k * math.pi / 3)
        parts.append(shape("box", (0.008, 0.045, 0.02), R @ [0.07, 0, 0], R))
    return scene("nut", [body("post", 20, box_inertia(20, (0.1, 0.1, 0.02)), (0, 0, foot), shapes=post),
                         body("nut", 2, (0.0052, 0.0052, 0.0098), middle, shapes=parts)],
                 duration=duration, sample=0.01, friction=friction, ground=True, collide=True)


# ---- Feet ----------------------------------------------------------------------------------------

OUTER, CARRIAGE, INNER = 4.5, 0.5, 5.0  # masses of what walks [kg]
LIFT, SWING = 3.0, 4.0                  # accelerations [m/s²]: 30 mm up, 90 mm forward


def step_of(start, lifted, swinging, forward):
    """Forces up and forward, each from a time on: up in 0.2 s, forward in 0.3 s, down in 0.2 s, and 0.3 s of rest."""
    up = [(0.0, GRAVITY + LIFT), (0.1, GRAVITY - LIFT), (0.2, GRAVITY), (0.5, GRAVITY - LIFT), (0.6, GRAVITY + LIFT), (0.7, 0.0)]
    along = [(0.2, SWING), (0.35, -SWING), (0.5, 0.0)]
    return ([(round(start + t, 3), forward * lifted * a) for t, a in up],
            [(round(start + t, 3), forward * swinging * a) for t, a in along])


def feet():
    """Two frames with four feet each, one within the other, on a slide forward and a slide up between them. By turns one is
    lifted, swung 90 mm forward and set down, three times each, askew to the axes. Standing feet bear 45 % of what slips."""
    R = turn((0, 0, 1), math.radians(37))
    height = 0.15

    def frame(name, mass, x, y):
        soles = [shape("box", (0.03, 0.02, 0.01), (sx * x, sy * y, 0.01 - height)) for sx in (1, -1) for sy in (1, -1)]
        return body(name, mass, box_inertia(mass, (x, y, 0.03)), (0, 0, height), R, shapes=soles)

    up, along = [], []
    for stride in range(3):
        for k, (lifted, swinging, forward) in enumerate(((INNER, INNER + CARRIAGE, 1), (OUTER + CARRIAGE, OUTER, -1))):
            more = step_of(0.2 + 2.0 * stride + k, lifted, swinging, forward)
            up += more[0]
            along += more[1]
    carriage = body("carriage", CARRIAGE, box_inertia(CARRIAGE, (0.05, 0.05, 0.05)), (0, 0, height), R)
    return scene("feet", [frame("outer", OUTER, 0.3, 0.2), carriage, frame("inner", INNER, 0.15, 0.1)],
                 [joint("slider", 0, 1, (0, 0, height), R @ [1, 0, 0], program=along),
                  joint("slider", 1, 2, (0, 0, height), (0, 0, 1), program=up)],
                 duration=6.4, friction=0.5, ground=True)
