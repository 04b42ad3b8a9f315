# SPDX-License-Identifier: Apache-2.0
"""Writes the scenes of the study as plain data (scene.hpp): scenes.py FOLDER [NAME...].

Bodies are given in maximal coordinates, so that no engine's description is favoured. No number here
is a result: what should come out is known to the judge alone.
"""
import json
import math
import pathlib
import random
import sys
import xml.etree.ElementTree as xml

import numpy as np

import machines
from bodies import GRAVITY, body, box, box_inertia, capsule, joint, scene, shape, sphere, turn

DIRECTIONS = (0, 22.5, 37, 45, 75, 120, 200, 300)  # of thrown boxes [degrees]
SPEEDS = (0.5, 1, 2, 4)  # [m/s]
# What differs in nothing but its size: numbers of bodies.
SIZES = {"chain": (5, 10, 20, 40), "tower": (5, 10, 20, 40), "pile": (10, 25, 50, 100)}


# ---- Smooth motion -------------------------------------------------------------------------------

def chain(count, first, bend, duration):
    """Links of 0.2 m and 1 kg that hang from the world, hinges across one another."""
    bodies, joints = [], []
    R, end = np.eye(3), np.zeros(3)
    for i in range(count):
        axis = np.array([0, 1, 0]) if i % 2 == 0 else np.array([1, 0, 0])
        joints.append(joint("hinge", i - 1, i, end, R @ axis))
        R = R @ turn(axis, bend if i else first)
        bodies.append(body(f"link{i}", 1, box_inertia(1, (0.02, 0.02, 0.1)), end + R @ [0, 0, -0.1], R))
        end = end + R @ [0, 0, -0.2]
    return scene("smooth", bodies, joints, duration=duration)


def free_body():
    return scene("free", [body("body", 2, box_inertia(2, (0.05, 0.1, 0.15)), (0, 0, 1), spin=(0.5, 50, 0.5))],
                 duration=10, sample=0.05, gravity=(0, 0, 0))


def thrown_body():
    """A free box after Peters and Hsu: a parabola, and energy and angular momentum that stay."""
    return scene("free", [body("body", 8, box_inertia(8, (0.05, 0.2, 0.45)), (0, 0, 1),
                               velocity=(-0.9, 0.4, 0.1), spin=(0.5, -3, 0.7))], duration=10, sample=0.1)


def published_body():
    """The box of scpeters/benchmark, test_results/BENCHMARK_boxes_dt.csv, that is `complex`."""
    return scene("free", [body("body", 10, box_inertia(10, (0.05, 0.2, 0.45)), (0, 0, 0), velocity=(-2, 2, 8), spin=(0.1, 5, 0.1))],
                 duration=10, sample=0.01, gravity=(0, 0, -9.8))


def published_bounce():
    """One of the 49 balls of SimBenchmark's bouncing, which do not touch one another and lose nothing."""
    return scene("elastic", [sphere("ball", 10, 0.1, (0, 0, 5))], duration=20, sample=0.001, ground=True, restitution=1.0)


def published_rolling():
    """SimBenchmark's rolling: a box is pushed askew on the ground and carries 25 balls. Theirs begin 20 µm deep."""
    pushed = 150 * np.array([0.5, math.sqrt(0.75), 0])
    bodies = [box("box", 10, (10, 10, 0.5), (0, 0, 0.5), force=list(pushed))]
    bodies += [sphere(f"ball{i}{j}", 1, 0.5, (2 * i - 4, 2 * j - 4, 1.5)) for i in range(5) for j in range(5)]
    return scene("pushed", bodies, duration=4, sample=0.001, friction=0.8, ground=True, collide=True, ground_friction=0.4)


def top():
    R = turn((1, 0, 0), math.radians(20))
    spin = R @ [0, 0, 100]
    centre = R @ [0, 0, 0.1]
    return scene("top", [body("top", 1, (0.0012, 0.0012, 0.002), centre, R,
                              velocity=np.cross(spin, centre), spin=spin)],
                 [joint("ball", -1, 0, (0, 0, 0))], duration=10, sample=0.01)


# ---- One contact ---------------------------------------------------------------------------------

def thrown(angle, speed):
    a = math.radians(angle)
    return scene("thrown", [box("box", 1, (0.1, 0.1, 0.05), (0, 0, 0.05),
                                velocity=(speed * math.cos(a), speed * math.sin(a), 0))],
                 duration=speed / (0.5 * GRAVITY) + 0.5, ground=True)


def incline(slope, friction, duration, askew=0.0, half=(0.1, 0.1, 0.05), measure="creep"):
    """A plane that is level, and gravity that is not."""
    a = math.radians(askew)
    down = math.sin(slope) * np.array([math.cos(a), math.sin(a), 0]) - math.cos(slope) * np.array([0, 0, 1])
    return scene(measure, [box("box", 1, half, (0, 0, half[2]))], duration=duration, sample=0.05,
                 friction=friction, ground=True, gravity=GRAVITY * down)


def of_cone(share, friction, askew=0.0):
    return incline(math.atan(share * friction), friction, 20, askew, half=(0.1, 0.1, 0.1))


def rolling():
    """A ball that is thrown without spin slides until it rolls at 5/7 of its speed."""
    return scene("rolling", [sphere("ball", 1, 0.1, (0, 0, 0.1), velocity=(2, 0, 0))], duration=1,
                 friction=0.3, ground=True)


def drop():
    return scene("drop", [sphere("ball", 1, 0.1, (0, 0, 1.1))], duration=3, sample=0.002, ground=True)


# ---- Many contacts -------------------------------------------------------------------------------

def tower(count, duration=10, masses=None):
    masses = masses or [1] * count
    return scene("tower", [box(f"box{i}", m, (0.1, 0.1, 0.1), (0, 0, 0.1 + 0.2 * i))
                           for i, m in enumerate(masses)],
                 duration=duration, sample=0.05, friction=1.0, ground=True, collide=True)


def grip():
    """Two fingers press a cube of 0.1 kg by 10 N each: ten times what friction needs."""
    bodies, joints = [], []
    for i, side in enumerate((1, -1)):
        bodies.append(box(("left", "right")[i], 0.2, (0.01, 0.02, 0.03), (-side * 0.03, 0, 0.5)))
        joints.append(joint("slider", -1, i, (-side * 0.03, 0, 0.5), (side, 0, 0), force=10.0))
    bodies.append(box("cube", 0.1, (0.02, 0.02, 0.02), (0, 0, 0.5)))
    return scene("grip", bodies, joints, duration=60, sample=0.1, collide=True)


def shaken_grip():
    """The gripper is the bob of a pendulum of 1 m, released at 60°. At the lowest point the cube pulls with
    twice its weight, a fifth of what friction bears."""
    R, hinge = turn((0, 1, 0), math.radians(60)), np.array([0, 0, 1.5])
    at = lambda y: hinge + R @ [0, y, -1]
    bodies = [body("palm", 1, box_inertia(1, (0.05, 0.05, 0.02)), at(0), R)]
    joints = [joint("hinge", -1, 0, hinge, (0, 1, 0))]
    for i, side in enumerate((1, -1)):
        bodies.append(box(("left", "right")[i], 0.2, (0.02, 0.01, 0.03), at(-side * 0.03), R=R))
        joints.append(joint("slider", 0, i + 1, at(-side * 0.03), (0, side, 0), force=10.0))
    bodies.append(box("cube", 0.1, (0.02, 0.02, 0.02), at(0), R=R))
    return scene("carried", bodies, joints, duration=20, sample=0.02, collide=True)


def cart():
    """A cart lands on four balls at 1 m/s that do not turn yet: they slide until they roll."""
    bodies = [body("chassis", 4, box_inertia(4, (0.2, 0.1, 0.03)), (0, 0, 0.1), velocity=(1, 0, 0))]
    joints = []
    for x in (0.15, -0.15):
        for y in (0.12, -0.12):
            joints.append(joint("hinge", 0, len(bodies), (x, y, 0.05), (0, 1, 0)))
            bodies.append(sphere(f"wheel{len(bodies)}", 0.2, 0.05, (x, y, 0.05), velocity=(1, 0, 0)))
    return scene("cart", bodies, joints, duration=10, sample=0.05, friction=0.8, ground=True)


def peg():
    """A square peg of 20 mm falls into a hole of 21 mm from 2 mm above it, turned by half a degree and pushed aside."""
    clear, wall, high = 0.0105, 0.00975, 0.04
    sides = [shape("box", (wall, clear + 2 * wall, high), (s * (clear + wall), 0, 0)) for s in (1, -1)]
    sides += [shape("box", (clear, wall, high), (0, s * (clear + wall), 0)) for s in (1, -1)]
    block = body("block", 20, box_inertia(20, (0.03, 0.03, high)), (0, 0, high), shapes=sides)
    return scene("peg", [block, box("peg", 0.05, (0.01, 0.01, 0.03), (0, 0, 0.112), R=turn((0, 0, 1), math.radians(0.5)),
                                    velocity=(0.01, 0.004, 0))],
                 duration=2, sample=0.01, friction=0.3, ground=True, collide=True)


def rope():
    """100 kg on five bars of 0.1 kg, released level; every joint is a tie."""
    bodies = [body(f"bar{i}", 0.1, box_inertia(0.1, (0.03, 0.01, 0.01)), (0.05 + 0.1 * i, 0, 1)) for i in range(5)]
    bodies.append(body("load", 100, 3 * [0.4 * 100 * 0.015 ** 2], (0.5, 0, 1)))
    return scene("rope", bodies, [joint("tie", i - 1, i, (0.1 * i, 0, 1)) for i in range(6)], duration=2, sample=0.01)


def random_turn(r):
    q = np.array([r.gauss(0, 1) for _ in range(4)])
    w, x, y, z = q / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def pile(count):
    """Boxes, capsules and balls above one another, apart."""
    r = random.Random(7)
    bodies = []
    for i in range(count):
        layer, cell = divmod(i, 9)
        at = ((cell % 3 - 1) * 0.34, (cell // 3 - 1) * 0.34, 0.25 + layer * 0.36)
        at = [x + r.uniform(-0.01, 0.01) for x in at]
        make = (lambda n, p, **k: box(n, 6, (0.12, 0.09, 0.07), p, **k),
                lambda n, p, **k: capsule(n, 4, 0.07, 0.08, p, **k),
                lambda n, p, **k: sphere(n, 5, 0.11, p, **k))[i % 3]
        bodies.append(make(f"body{i}", at, R=random_turn(r)))
    return scene("pile", bodies, duration=4, sample=0.05, friction=0.7, ground=True, collide=True)


def capsules():
    """27 capsules of 0.3 m, each further from the next than it is long."""
    r = random.Random(3)
    return scene("pile", [capsule(f"capsule{i}", 1, 0.05, 0.1, (0.31 * (i % 3), 0.31 * (i // 3 % 3), 0.25 + 0.31 * (i // 9)),
                                  R=random_turn(r)) for i in range(27)],
                 duration=4, sample=0.05, ground=True, collide=True)


# ---- The humanoid --------------------------------------------------------------------------------

STAGE_MASS = 0.1  # kg of a link that the file has without mass, which half of the engines refuse


def numbers(element, key, otherwise="0 0 0"):
    return np.array([float(x) for x in (element.get(key, otherwise) if element is not None else otherwise).split()])


def pose(element):
    """Position and rotation of an <origin>."""
    roll, pitch, yaw = numbers(element, "rpy")
    return numbers(element, "xyz"), turn((0, 0, 1), yaw) @ turn((0, 1, 0), pitch) @ turn((1, 0, 0), roll)


def collision_shapes(link):
    """Kind, size, position and rotation of each: cylinders are capsules, and the spheres at their ends part of them."""
    shapes, caps = [], []
    for collision in link.findall("collision"):
        at, R = pose(collision.find("origin"))
        form = collision.find("geometry")[0]
        if form.tag == "cylinder":
            radius, half = float(form.get("radius")), 0.5 * float(form.get("length"))
            caps += [(radius, at + R @ [0, 0, s * half]) for s in (-1, 1)]
            shapes.append(("capsule", (radius, half, 0), at, R))
        elif form.tag == "sphere":
            shapes.append(("sphere", (float(form.get("radius")), 0, 0), at, R))
        else:
            shapes.append(("box", 0.5 * numbers(form, "size"), at, R))
    return [s for s in shapes if not (s[0] == "sphere" and any(
        abs(s[1][0] - r) < 1e-9 and np.linalg.norm(s[2] - c) < 1e-6 for r, c in caps))]


def inertial(link):
    """Mass, centre of mass and inertia about it, in link axes."""
    element = link.find("inertial")
    if element is None:
        return STAGE_MASS, np.zeros(3), 1e-3 * STAGE_MASS * np.eye(3)
    centre, R = pose(element.find("origin"))
    tensor = element.find("inertia")
    xx, xy, xz, yy, yz, zz = (float(tensor.get(k)) for k in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))
    return (float(element.find("mass").get("value")), centre,
            R @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ R.T)


def welded(name, links, children):
    """Inertias and shapes of a link and of all that is fixed to it, in its frame."""
    inertias, shapes = [inertial(links[name])], collision_shapes(links[name])
    for j in children.get(name, []):
        if j.get("type") != "fixed":
            continue
        at, R = pose(j.find("origin"))
        more, forms = welded(j.find("child").get("link"), links, children)
        inertias += [(m, at + R @ c, R @ I @ R.T) for m, c, I in more]
        shapes += [(kind, size, at + R @ p, R @ Q) for kind, size, p, Q in forms]
    return inertias, shapes


def principal(inertias):
    """Mass, centre of mass, principal moments and axes of several together."""
    mass = sum(m for m, _, _ in inertias)
    centre = sum(m * c for m, c, _ in inertias) / mass
    I = sum(J + m * (np.dot(c - centre, c - centre) * np.eye(3) - np.outer(c - centre, c - centre))
            for m, c, J in inertias)
    if np.abs(I - np.diag(np.diag(I))).max() == 0:
        return mass, centre, np.diag(I), np.eye(3)
    moments, axes = np.linalg.eigh(I)
    if np.linalg.det(axes) < 0:
        axes[:, 0] *= -1
    return mass, centre, moments, axes


def humanoid(height, root_velocity, root_spin, joint_speed, limits):
    """The humanoid of data/robots, straight, its joints at the speeds joint_speed(number)."""
    robot = xml.parse(pathlib.Path(__file__).parents[2] / "data/robots/humanoid.urdf").getroot()
    links = {l.get("name"): l for l in robot.findall("link")}
    children = {}
    for j in robot.findall("joint"):
        children.setdefault(j.find("parent").get("link"), []).append(j)
    bodies, joints = [], []

    def add(name, at, R, v, w):
        me = len(bodies)
        inertias, shapes = welded(name, links, children)
        mass, centre, moments, axes = principal(inertias)
        bodies.append(body(name, mass, moments, at + R @ centre, R @ axes, velocity=v + np.cross(w, R @ centre), spin=w,
                           shapes=[shape(kind, size, axes.T @ (p - centre), axes.T @ Q) for kind, size, p, Q in shapes]))
        for j in children.get(name, []):
            if j.get("type") == "fixed":
                continue
            p, turned = pose(j.find("origin"))
            axis = R @ turned @ numbers(j.find("axis"), "xyz")
            limit = [float(j.find("limit").get(k)) for k in ("lower", "upper")]
            joints.append(joint("hinge", me, len(bodies), at + R @ p, axis, limits=limit if limits else None))
            add(j.find("child").get("link"), at + R @ p, R @ turned, v + np.cross(w, R @ p),
                w + axis * joint_speed(len(bodies)))

    root = (set(links) - {j.find("child").get("link") for j in robot.findall("joint")}).pop()
    add(root, np.array([0, 0, height]), np.eye(3), np.array(root_velocity, float), np.array(root_spin, float))
    return bodies, joints


def humanoid_in_the_air():
    bodies, joints = humanoid(1, (0.3, -0.2, 0.1), (0.5, -0.8, 0.4), lambda i: math.sin(1 + 1.7 * (5 + i)), False)
    for b in bodies:
        b["shapes"] = []
    return scene("smooth", bodies, joints, duration=1, gravity=(0, 0, 0))


def humanoid_falls():
    bodies, joints = humanoid(0.97, (0, 0, 0), (0, 0, 0), lambda i: 0.1 * math.sin(1 + 1.7 * i), True)
    return scene("pile", bodies, joints, duration=3, sample=0.05, friction=0.8, ground=True)


# ---- All -----------------------------------------------------------------------------------------

def all_scenes():
    scenes = {
        **{f"{name}_{n}": make(n) for name, make in (("chain", lambda n: chain(n, 1.2, 0.05, 2)), ("tower", tower), ("pile", pile))
           for n in SIZES[name]},
        "chain_10_long": chain(10, 1.2, 0.1, 10),
        "humanoid_in_the_air": humanoid_in_the_air(),
        "top": top(),
        "free_body": free_body(),
        "thrown_body": thrown_body(),
        "published_body": published_body(), "published_bounce": published_bounce(), "published_rolling": published_rolling(),
        "slides_37": incline(math.radians(37), 0.5, 1, measure="slides"),
        "creep_15": incline(math.radians(15), 1.0, 10, half=(0.1, 0.1, 0.1)),
        "creep_50": of_cone(0.5, 0.5),
        "creep_99": of_cone(0.99, 0.5),
        "creep_99_askew": of_cone(0.99, 0.5, 37),
        "rolling": rolling(),
        **{f"bounce_{kind}_{100 * e:g}": machines.bounce(kind, e) for kind in ("ball", "box") for e in machines.RESTITUTIONS},
        "drop": drop(),
        "mass_1000": tower(2, 5, [1, 1000]),
        "grip": grip(),
        "grip_shaken": shaken_grip(), "cart": cart(), "peg": peg(),
        "nut_rests": machines.nut(0.4, 10), "nut_runs": machines.nut(0.1, 0.6), "feet": machines.feet(),
        "rope": rope(),
        "humanoid_falls": humanoid_falls(),
        "capsules_27": capsules(),
    }
    for speed in SPEEDS:
        for angle in DIRECTIONS:
            scenes[f"thrown_{speed:g}_{angle:g}"] = thrown(angle, speed)
    return scenes


def main(folder, names):
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in all_scenes().items():
        if not names or name in names:
            (folder / f"{name}.json").write_text(json.dumps({"name": name, **content}, indent=1) + "\n")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
