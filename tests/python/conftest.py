# SPDX-License-Identifier: Apache-2.0
"""What the tests of the Python module share."""

import os
import pathlib

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
ROBOTS = SOURCE / "data" / "robots"
SCENES = SOURCE / "data" / "scenes"
EXAMPLES = SOURCE / "apps" / "python" / "examples"

os.environ.setdefault("MPLBACKEND", "Agg")


@pytest.fixture
def arm():
    import softgauss

    return softgauss.Simulation(ROBOTS / "arm.urdf")


@pytest.fixture
def humanoid():
    import softgauss

    return softgauss.Simulation(ROBOTS / "humanoid.urdf")
