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
