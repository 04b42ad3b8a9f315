# SPDX-License-Identifier: Apache-2.0
"""What is wrong is told, and leaves what was there."""

import subprocess
import sys

import numpy as np
import pytest
from conftest import ROBOTS

import softgauss


def test_errors_say_what_the_program_says(tmp_path):
    with pytest.raises(softgauss.ModelError, match="nothing.urdf"):
        softgauss.Simulation(tmp_path / "nothing.urdf")
    bad = tmp_path / "bad.urdf"
    bad.write_text("<robot name='r'><link name='a'/><link name='b'/></robot>")
    with pytest.raises(ValueError, match=r"bad\.urdf"):
        softgauss.Simulation(bad)


def test_wrong_arguments_are_told(arm):
    with pytest.raises(softgauss.UnknownName, match="did you mean 'hand'"):
        arm.goals.reach("hnd", [0, 0, 0])
    with pytest.raises(softgauss.UnknownName, match="did you mean 'elbow_pitch'"):
        arm.position("elbow_pich")
    with pytest.raises(softgauss.ModelError, match="goals:1: goal 1 'reach': key 'weight'"):
        arm.goals.add({"reach": {"link": "hand", "target": [0, 0, 0], "weight": -1}})
    with pytest.raises(softgauss.ModelError, match="unknown kind"):
        arm.goals.add({"raech": {}})
    with pytest.raises(ValueError, match=r"q: found shape \(3,\), expected \(nq,\) = \(7,\)"):
        arm.q = [1, 2, 3]
    with pytest.raises(TypeError, match="expected numbers"):
        arm.v = ["a"] * 7
    with pytest.raises(TypeError, match="expected one of base, "):
        softgauss.Simulation(ROBOTS / "arm.urdf", timestp=0.001)
    with pytest.raises(
        ValueError, match="cone: found 'round', expected one of pyramidal, elliptic"
    ):
        softgauss.Simulation(ROBOTS / "arm.urdf", cone="round")
    with pytest.raises(TypeError, match="timestep: found 'fast', expected a number"):
        softgauss.Simulation(ROBOTS / "arm.urdf", timestep="fast")
    with pytest.raises(softgauss.OptionError, match="q0"):
        softgauss.Simulation(ROBOTS / "arm.urdf", q0={"elbow_pitch": 99.0})
    with pytest.raises(ValueError, match="0 or more"):
        arm.step(-1)
    with pytest.raises(AttributeError, match="nothing"):
        softgauss.nothing


@pytest.mark.parametrize("bad", [-5.0, -1e-300, np.nan, np.inf])
def test_a_weight_is_a_finite_number_from_0(arm, bad):
    goal = arm.goals.reach("hand", [0.5, 0.2, 0.5], weight=4.0)
    said = rf"weight: found {bad}, expected a finite number >= 0"
    for give in (
        lambda: arm.goals.posture(bad),
        lambda: arm.goals.reach("hand", [0.5, 0.2, 0.5], weight=bad),
        lambda: arm.goals.reach("hand", [0.5, 0.2, 0.5], point=[0, 0, 0.1], weight=bad),
        lambda: setattr(goal, "weight", bad),
    ):
        count = len(arm.goals)
        with pytest.raises(ValueError, match=said):
            give()
        assert goal.weight == 4.0 and len(arm.goals) == count
    with pytest.raises(softgauss.ModelError, match="expected a finite number >= 0"):
        arm.goals.add({"posture": {"weight": bad}})


def test_times_and_places_of_goals_are_numbers(arm):
    goal = arm.goals.reach("hand", [0.5, 0.2, 0.5])
    for name in ("start", "end"):
        with pytest.raises(ValueError, match=name + ": found nan, expected a time"):
            setattr(goal, name, np.nan)
    goal.start, goal.end = -np.inf, np.inf  # always
    for place in ({"target": [np.nan, 0, 0]}, {"target": [0, 0, 0], "point": [0, np.inf, 0]}):
        with pytest.raises(ValueError, match="expected finite numbers"):
            arm.goals.reach("hand", **place)
    assert goal.target.tolist() == [0.5, 0.2, 0.5]


UNMADE = """
import sys, softgauss

def expect_refusal(use):
    try:
        use()
    except TypeError as error:
        assert "was not initialised" in str(error), error
    else:
        sys.exit(1)

kind = getattr(softgauss, sys.argv[1])
names = [name for name, member in vars(kind).items() if isinstance(member, property)]
for name in names:
    expect_refusal(lambda: getattr(kind.__new__(kind), name))
if hasattr(kind, "__len__"):
    expect_refusal(lambda: len(kind.__new__(kind)))
sim = softgauss.Simulation.__new__(softgauss.Simulation)
expect_refusal(sim.step)
expect_refusal(lambda: softgauss.Rollout(sim))
expect_refusal(lambda: softgauss.States(sim, 1))
"""


@pytest.mark.parametrize(
    "name", ["Simulation", "States", "Rollout", "Goals", "Goal", "Runs", "Contacts", "Solution"]
)
def test_an_object_that_was_not_initialised_is_told(name):
    """In a process of its own: what pybind11 would do is to read memory that nobody has filled."""
    assert subprocess.run([sys.executable, "-c", UNMADE, name], timeout=60).returncode == 0


def test_a_refused_step_leaves_the_state_and_tells_why(arm):
    arm.step(5)
    before, time = arm.q.copy(), arm.time
    arm.tau[2] = np.nan
    with pytest.raises(softgauss.StepError, match=arm.joints[2]):
        arm.step()
    assert np.array_equal(before, arm.q) and arm.time == time
