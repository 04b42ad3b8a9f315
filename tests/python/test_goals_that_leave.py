# SPDX-License-Identifier: Apache-2.0
"""Goals that are removed or cleared: they act no more, and who held them is told."""

import numpy as np
import pytest
from conftest import ROBOTS

import softgauss


def test_a_goal_that_is_gone_steers_no_other(arm):
    """A new goal often lies where a cleared one lay: the old handle is of neither."""
    for _ in range(20):
        old = [arm.goals.reach("hand", [0.4, 0.0, 0.4]), arm.goals.posture(), arm.goals[0]]
        arm.goals.clear()
        new = arm.goals.reach("hand", [0.5, 0.3, 0.5])
        for goal in old:
            with pytest.raises(RuntimeError, match="gone"):
                goal.target = np.zeros(3)
            with pytest.raises(RuntimeError, match="gone"):
                goal.weight
        assert new.target.tolist() == [0.5, 0.3, 0.5]


def test_a_goal_that_is_removed_acts_no_more(arm):
    left = softgauss.Simulation(ROBOTS / "arm.urdf")
    left.goals.posture()
    goal = arm.goals.reach("hand", [0.4, 0.0, 0.4])
    posture = arm.goals.posture()
    arm.step()
    goal.remove()
    for gone in (lambda: goal.target, goal.remove):
        with pytest.raises(RuntimeError, match="gone"):
            gone()
    assert posture.name == "posture" and [g.name for g in arm.goals] == [g.name for g in left.goals]
    arm.reset()
    arm.step(20)
    left.step(20)
    assert np.array_equal(arm.q, left.q)
    # One that comes with others may go too, and come again.
    del arm.goals[0]
    assert "posture" not in [g.name for g in arm.goals]
    with pytest.raises(RuntimeError, match="gone"):
        posture.weight
    assert arm.goals.posture().name == "posture" and arm.goals[-1].name == "posture"
    with pytest.raises(IndexError, match="found 7"):
        del arm.goals[7]


def test_a_goal_where_another_was_is_its_own(arm):
    for _ in range(20):
        old = arm.goals.add({"look_at": {"link": "hand", "target": [1, 0, 0]}})[0]
        old.remove()
        (new,) = arm.goals.add({"look_at": {"link": "hand", "target": [0, 1, 0]}})
        with pytest.raises(RuntimeError, match="gone"):
            old.target
        assert new.target.tolist() == [0, 1, 0]
        new.remove()
    assert len(arm.goals) == 0
