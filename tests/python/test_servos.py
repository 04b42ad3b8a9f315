# SPDX-License-Identifier: Apache-2.0
"""Servos are told where to go, and tell what their drives would be sent."""

import pytest
from conftest import ROBOTS

import softgauss


def test_servos_follow_their_set_points(tmp_path):
    scene = tmp_path / "arm.yaml"
    scene.write_text(
        f"gravity: [0, 0, 0]\nrobots:\n  - urdf: {ROBOTS / 'arm.urdf'}\n    base: fixed\n"
        "    joint_parameters: {elbow_pitch: {servo: {kp: 100, kd: 10}}}\n"
    )
    sim = softgauss.Simulation(scene)
    sim.set_set_point("elbow_pitch", 0.4)
    sim.run(3.0)
    # Without gravity its spring bears nothing.
    assert sim.position("elbow_pitch") == pytest.approx(0.4, abs=1e-4)
    assert sim.set_point("elbow_pitch") == pytest.approx(0.4, abs=1e-4)
    with pytest.raises(softgauss.UnknownName, match="has no servo"):
        sim.set_set_point("shoulder_yaw", 0.1)
    assert softgauss.Simulation(scene, without_servos=True).torque("elbow_pitch") == 0.0
