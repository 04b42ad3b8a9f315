# SPDX-License-Identifier: Apache-2.0
"""What holds a goal back, asked in the middle of a run."""

import pytest
from conftest import ROBOTS

import softgauss


def test_a_goal_says_what_holds_it_back():
    sim = softgauss.Simulation(ROBOTS / "arm.urdf")
    reach = sim.goals.reach("hand", [0.5, 0.3, 0.5], weight=1.0)
    posture = sim.goals.posture(1e4)
    sim.run(2.0)
    causes = reach.held_back()
    assert causes[0][0] == posture.name and causes[0][1] > 0.5
    assert sum(share for _, share in causes) == pytest.approx(1.0, abs=1e-12)
    sim.goals.clear()
    with pytest.raises(RuntimeError):
        reach.held_back()
