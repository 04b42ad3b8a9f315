# SPDX-License-Identifier: Apache-2.0
"""What an interactive session prints of objects."""

import softgauss


def test_say_of_what_they_are(humanoid):
    assert repr(humanoid.goals) == "<softgauss.Goals: none>"
    humanoid.goals.posture()
    humanoid.run(0.01)
    nv = humanoid.nv
    said = f"<softgauss.Simulation of '{humanoid.name}': {nv} degrees of freedom, 2 goals, at 0.01 s>"
    assert repr(humanoid) == said
    assert repr(humanoid.goals).startswith("<softgauss.Goals: ")
    assert "posture" in repr(humanoid.goals)
    points = len(humanoid.contacts)
    assert repr(humanoid.contacts) == f"<softgauss.Contacts: {points} points>"
    assert repr(humanoid.solve()).startswith("<softgauss.Solution: converged, certified, ")


def test_say_how_many(arm):
    rollout = softgauss.Rollout(arm, threads=1)
    assert repr(rollout) == "<softgauss.Rollout on 1 thread>"
    assert repr(rollout.run(3, q0=[arm.q] * 2)) == "<softgauss.Runs: 2, 0 failed>"
    assert repr(softgauss.States(arm, 5)) == "<softgauss.States: 5>"
