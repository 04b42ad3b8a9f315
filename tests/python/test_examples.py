# SPDX-License-Identifier: Apache-2.0
"""The examples, shortened: they run, and what they show is so."""

import csv
import re
import subprocess
import sys

import numpy as np
import pytest
from conftest import EXAMPLES, ROBOTS, SCENES

import softgauss

sys.path.insert(0, str(EXAMPLES))

ARM, HUMANOID = ROBOTS / "arm.urdf", ROBOTS / "humanoid.urdf"


def run(script, *arguments, cwd):
    done = subprocess.run(
        [sys.executable, EXAMPLES / script, *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def is_picture(file):
    return file.read_text().lstrip().startswith("<?xml") and "<svg" in file.read_text()


def test_plot_reach(tmp_path):
    said = run("plot_reach.py", ARM, "--out", "reach.svg", cwd=tmp_path)
    assert float(re.search(r"ends ([\d.]+) mm", said).group(1)) < 20.0
    assert is_picture(tmp_path / "reach.svg")


def test_sweep_grasp(tmp_path):
    said = run(
        "sweep_grasp.py",
        SCENES / "hand_and_ball.yaml",
        "--points",
        3,
        "--seconds",
        0.5,
        "--out",
        "grasp.svg",
        cwd=tmp_path,
    )
    assert "of 9 balls are held" in said and is_picture(tmp_path / "grasp.svg")


def test_a_hand_holds_what_is_rough_and_light():
    from sweep_grasp import sweep

    held, fallen = sweep(SCENES / "hand_and_ball.yaml", [0.02, 1.0], [0.05, 20.0], 0.6)
    assert held[1, 0] and not held[1, 1] and not held[0, 1]
    assert abs(fallen[1, 0]) < 0.01


def test_the_picture_of_the_sweep_shows_where_the_hand_loses_the_ball():
    """At the ends of its axes all is held, or nothing."""
    from sweep_grasp import FRICTIONS, MASSES, sweep

    held, fallen = sweep(SCENES / "hand_and_ball.yaml", FRICTIONS, MASSES, 0.6)
    assert held[:, 0].all() and not held[:, 1].any()
    assert np.abs(fallen[:, 0]).max() < 0.01 and fallen[:, 1].min() > 0.1


@pytest.mark.parametrize("joint, truth", [("elbow_pitch", 1.7), ("shoulder_yaw", 0.4)])
def test_identify_damping(tmp_path, joint, truth):
    said = run("identify_damping.py", ARM, joint, "--truth", truth, "--noise", 1e-4, cwd=tmp_path)
    found = float(re.search(r"damping of \w+: ([\d.e+-]+) N m s/rad", said).group(1))
    assert found == pytest.approx(truth, rel=0.05)  # what a noise of 1e-4 rad leaves of it


def test_identify_damping_reads_a_log_of_simulate_gdd(tmp_path):
    """A log has a last row without torques, and columns that are not asked for."""
    from identify_damping import make_log, read_log

    sim = softgauss.Simulation(ARM)
    make_log(tmp_path / "a.csv", sim, "elbow_pitch", 1.0, 0.0, seconds=0.1)
    with open(tmp_path / "a.csv", newline="") as text:
        rows = list(csv.DictReader(text))
    for row in rows:
        row["contacts"] = "0"
        if row is rows[-1]:
            row.update({name: "" for name in row if name.startswith("u:")})
    with open(tmp_path / "b.csv", "w", newline="") as out:
        write = csv.DictWriter(out, rows[0].keys())
        write.writeheader()
        write.writerows(rows)
    for one, other in zip(read_log(tmp_path / "a.csv", sim), read_log(tmp_path / "b.csv", sim)):
        assert np.array_equal(one, other)


def a_log(file, change=lambda rows: rows, **options):
    """Of an arm whose elbow has a damping of 1; `change` makes other rows of it."""
    from identify_damping import make_log

    make_log(file, softgauss.Simulation(ARM, **options), "elbow_pitch", 1.0, 0.0)
    with open(file, newline="") as text:
        rows = change(list(csv.DictReader(text)))
    with open(file, "w", newline="") as out:
        write = csv.DictWriter(out, rows[0].keys())
        write.writeheader()
        write.writerows(rows)


@pytest.mark.parametrize("timestep", [0.0005, 0.003, 0.004])
def test_identify_damping_takes_the_step_from_the_log(tmp_path, timestep):
    a_log(tmp_path / "log.csv", timestep=timestep)
    said = run("identify_damping.py", ARM, "elbow_pitch", "--log", "log.csv", cwd=tmp_path)
    found = float(re.search(r"damping of \w+: ([\d.e+-]+) N m s/rad", said).group(1))
    assert found == pytest.approx(1.0, rel=1e-3)  # four digits are printed


def without(column):
    return lambda rows: [{k: x for k, x in row.items() if k != column} for row in rows]


def with_value(column, row, value):
    return lambda rows: [x if i != row else {**x, column: value} for i, x in enumerate(rows)]


@pytest.mark.parametrize(
    "change, said",
    [
        (lambda rows: rows[:40] + rows[41:], r"log.csv:42: column 'time_s': found a row 0.004 s"),
        (lambda rows: rows[::-1], "column 'time_s'"),
        (lambda rows: rows[:2], "found 2 rows, expected 3 or more"),
        (without("time_s"), "found no column 'time_s'"),
        (without("u:wrist_pitch"), "found no column 'u:wrist_pitch'"),
        (with_value("u:elbow_pitch", 7, ""), "log.csv:9: column 'u:elbow_pitch': found ''"),
        (with_value("q:elbow_pitch", 7, "nan"), "log.csv:9: column 'q:elbow_pitch': found 'nan'"),
        (with_value("time_s", 7, "x"), "log.csv:9: column 'time_s': found 'x', expected a number"),
        (lambda rows: rows[::2], "no damping from 0.001 to 100 fits"),
        (lambda rows: rows[::5], "no damping from 0.001 to 100 fits"),
        (lambda rows: rows[::100], "no damping from 0.001 to 100 fits"),
        (lambda rows: [{**row, "time_s": 2 * float(row["time_s"])} for row in rows], "fits"),
    ],
)
def test_identify_damping_refuses_what_it_cannot_use(tmp_path, change, said):
    a_log(tmp_path / "log.csv", change)
    done = subprocess.run(
        [sys.executable, EXAMPLES / "identify_damping.py", ARM, "elbow_pitch", "--log", "log.csv"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 1 and re.search(said, done.stderr), (done.stdout, done.stderr)
    assert "Traceback" not in done.stderr and done.stdout == ""


@pytest.mark.parametrize("action", ["acceleration", "torque"])
def test_learning_lowers_the_cost(action):
    from learn_balance import SIZE, train

    mean, curve = train(
        HUMANOID,
        action,
        seconds=1e9,
        generations=3,
        population=24,
        trials=2,
        tests=6,
        strength=14.0,
        episode=1.0,
        tell=lambda line: None,
    )
    assert mean.shape == (SIZE,) and len(curve) == 4
    assert min(c["cost"] for c in curve[1:]) < curve[0]["cost"]
    assert curve[-1]["episodes"] == 3 * 24 * 2


def test_a_policy_is_symmetric():
    """The mirror image of a state gets the mirror image of the action."""
    from learn_balance import SIZE, Policy

    sim = softgauss.Simulation(HUMANOID)
    policy = Policy(sim.joints)
    random = np.random.default_rng(0)
    parameters = random.normal(size=(1, SIZE))
    q, v = sim.q[None] + random.normal(scale=0.1, size=(1, sim.nq)), random.normal(size=(1, sim.nv))
    swap = [
        sim.joints.index(j.replace("left", "*").replace("right", "left").replace("*", "right"))
        for j in sim.joints
    ]
    trunk = np.array([-1.0 if j in ("abdomen_roll", "abdomen_yaw") else 1.0 for j in sim.joints])
    mirror_q, mirror_v = q.copy(), v.copy()
    mirror_q[0, [1, 4, 6]] *= -1
    mirror_v[0, [1, 3, 5]] *= -1
    mirror_q[0, 7:], mirror_v[0, 6:] = (q[0, 7:] * trunk)[swap], (v[0, 6:] * trunk)[swap]
    action = (policy(parameters, q, v)[0] * trunk)[swap]
    assert np.allclose(policy(parameters, mirror_q, mirror_v)[0], action, rtol=0, atol=1e-12)


def test_measure_cost(tmp_path):
    said = run("measure_cost.py", ARM, "--steps", 50, "--rounds", 3, cwd=tmp_path)
    assert len(re.findall(r"µs", said)) >= 3
