# SPDX-License-Identifier: Apache-2.0
"""Replay pages of what was recorded, and gains of goals."""

import base64
import json
import re
import struct
import zlib

import numpy as np
import pytest
from conftest import ROBOTS

import softgauss


def run_in(page):
    """Header and an array by name, by docs/replay_format.md."""
    text = re.search(r'id="softgauss-run"[^>]*>([^<]+)<', page.read_text())[1]
    run = zlib.decompress(base64.b64decode(text))
    assert run[:8] == b"SGREPLAY"
    (size,) = struct.unpack("<I", run[12:16])
    header = json.loads(run[16 : 16 + size])
    first = (16 + size + 7) // 8 * 8
    kinds = {"f64": np.float64, "f32": np.float32, "u32": np.uint32, "u8": np.uint8}

    def array(name):
        a = header["arrays"][name]
        return np.frombuffer(run, kinds[a["type"]], a["length"], first + a["offset"])

    return header, array


def test_a_page_shows_what_was_recorded(tmp_path):
    sim = softgauss.Simulation(ROBOTS / "arm.urdf")
    sim.goals.reach("hand", [0.5, 0.3, 0.5])
    sim.run(0.5)
    sim.record()
    there = sim.pose("hand")[:3, 3]
    sim.run(1.0)
    sim.save_replay(tmp_path / "run.html")
    header, array = run_in(tmp_path / "run.html")
    assert header["goals"][0]["name"].startswith("reach hand")
    times = array("frame_time")
    assert times[0] == pytest.approx(0.5, abs=1e-9) and times[-1] == pytest.approx(1.5, abs=1e-9)
    points = array("goal_point").reshape(len(times), -1, 3) + np.array(header["origin"])
    assert points[0, 0] == pytest.approx(there, abs=1e-6)
    assert points[-1, 0] == pytest.approx(sim.pose("hand")[:3, 3], abs=1e-6)


def test_recording_changes_nothing_and_goes_on_and_back(tmp_path):
    bare, sim = (softgauss.Simulation(ROBOTS / "arm.urdf") for _ in range(2))
    for each in (bare, sim):
        each.goals.reach("hand", [0.5, 0.3, 0.5])
    sim.record()
    bare.run(0.4)
    sim.run(0.2)
    sim.save_replay(tmp_path / "run.html")  # the run goes on
    sim.run(0.2)
    assert sim.q.tobytes() == bare.q.tobytes() and sim.v.tobytes() == bare.v.tobytes()
    sim.reset()
    sim.run(0.1)
    sim.save_replay(tmp_path / "run.html")
    times = run_in(tmp_path / "run.html")[1]("frame_time")
    assert times[-1] == pytest.approx(0.1, abs=1e-9) and np.all(np.diff(times) > 0)


@pytest.mark.parametrize("leave", ["clear", "remove"])
def test_goals_that_have_left_are_shown_no_more(leave, tmp_path):
    sim = softgauss.Simulation(ROBOTS / "arm.urdf")
    goal = sim.goals.reach("hand", [0.5, 0.3, 0.5])
    sim.record()
    sim.run(0.1)
    goal.remove() if leave == "remove" else sim.goals.clear()
    sim.run(0.1)
    sim.save_replay(tmp_path / "run.html")
    header, array = run_in(tmp_path / "run.html")
    points = array("goal_point").reshape(len(array("frame_time")), -1)
    assert np.isfinite(points[0]).all() and np.isnan(points[-1]).all()


def test_what_is_not_recorded_is_not_saved(arm, tmp_path):
    with pytest.raises(RuntimeError, match="record"):
        arm.save_replay(tmp_path / "run.html")
    arm.record()
    with pytest.raises(softgauss.ModelError, match="nowhere"):
        arm.save_replay(tmp_path / "nowhere/run.html")


def test_gains_are_those_of_the_goal(arm):
    goal = arm.goals.reach("hand", [0.5, 0.3, 0.5])
    posture = arm.goals.posture()
    velocity, _ = arm.goals.add([{"joint_velocity": {"joints": {"elbow_pitch": 0.1}}}, {"damping": {}}])
    # At rest a reach asks for stiffness times the way that is left, whatever else acts.
    goal.stiffness, goal.damping = 50.0, 10.0
    assert (goal.stiffness, goal.damping) == (50.0, 10.0)
    assert posture.stiffness > 0 and velocity.rate > 0
    with pytest.raises(TypeError, match="no rate"):
        goal.rate
    with pytest.raises(ValueError, match="stiffness"):
        goal.stiffness = -1.0


def test_a_stiffer_goal_is_sought_faster():
    left = []
    for stiffness in (25.0, 100.0):
        sim = softgauss.Simulation(ROBOTS / "arm.urdf")
        # Alone, but for what keeps the elbow from drifting.
        goal, _ = sim.goals.add(
            [{"reach": {"link": "hand", "target": [0.5, 0.3, 0.5]}}, {"damping": {"weight": 1e-3}}]
        )
        goal.stiffness, goal.damping = stiffness, 2 * stiffness**0.5
        sim.run(0.3)
        left.append(np.linalg.norm(sim.pose("hand")[:3, 3] - [0.5, 0.3, 0.5]))
    # Critically damped from rest: (1 + w t) exp(-w t), 0.56 and 0.20 of the way.
    assert left[0] / left[1] == pytest.approx(0.5578 / 0.1991, rel=0.1)
