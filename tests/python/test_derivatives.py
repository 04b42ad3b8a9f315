# SPDX-License-Identifier: Apache-2.0
"""Derivatives of dynamics and of a step, beside central differences of the functions themselves."""

import numpy as np
import pytest
import softgauss
from conftest import ROBOTS
from test_dynamics import some_state

# Of differences: in contact less than the bodies overlap, lest contacts break.
H = {"in the air": 1e-6, "on the ground": 1e-8}


def column(sim, f, q, v, a, of, i):
    """Central difference of f(q, v, a) by coordinate i of one of them."""
    values = []
    step = H["on the ground" if len(sim.contacts) > 0 else "in the air"]
    if of == "a":  # of what is linear within a piece a larger one loses nothing
        step *= 1e4
    for sign in (1.0, -1.0):
        e = np.zeros(sim.nv)
        e[i] = sign * step
        at = {"q": sim.integrate(q, e), "v": v + e, "a": a + e}[of]
        values.append(f(*[at if of == name else x for name, x in (("q", q), ("v", v), ("a", a))]))
    return (values[0] - values[1]) / (2 * step)


def differences(sim, f, q, v, a, of):
    return np.array([column(sim, f, q, v, a, of, i) for i in range(sim.nv)]).T


def expect_close(found, expected):
    assert np.allclose(found, expected, rtol=0, atol=1e-6 * np.abs(expected).max() + 1e-6)


@pytest.fixture(params=H)
def robot(request):
    if request.param == "in the air":
        return softgauss.Simulation(ROBOTS / "humanoid.urdf", ground=None, base_height=5.0)
    sim = softgauss.Simulation(ROBOTS / "humanoid.urdf")
    sim.run(0.02)  # its feet press the ground
    assert len(sim.contacts) > 0
    return sim


def state_of(sim, seed):
    random = np.random.default_rng(seed)
    if len(sim.contacts) == 0:
        q, v = some_state(sim, seed)
    else:  # near where it stands, so that the same corners touch
        q, v = sim.q.copy(), 1e-3 * random.normal(size=sim.nv)
    return q, v, random.normal(scale=20.0, size=sim.nv)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("name", ["inverse_dynamics", "forward_dynamics"])
def test_of_dynamics(robot, name, seed):
    q, v, given = state_of(robot, seed)
    if name == "inverse_dynamics":
        given = robot.forward_dynamics(given, q, v)
    function = getattr(robot, name)
    found = getattr(robot, name + "_derivatives")(given, q, v)
    for of, matrix in zip("qva", found):
        expected = differences(robot, lambda q, v, x: function(x, q, v), q, v, given, of)
        expect_close(matrix, expected)


@pytest.mark.parametrize("seed", range(2))
def test_of_a_step(robot, seed):
    # The leapfrog by its parts: half the way, the solve there, the rest of the way.
    q, v, tau = state_of(robot, seed)
    h = robot.timestep

    def step(q, v, tau):
        middle = robot.integrate(q, v, 0.5 * h)
        ends = v + h * robot.forward_dynamics(tau, middle, v)
        return robot.integrate(middle, ends, 0.5 * h), ends

    there, _ = step(q, v, tau)

    def ends(q, v, tau):
        position, velocity = step(q, v, tau)
        return np.concatenate([robot.difference(there, position), velocity])

    A, B = robot.step_derivatives(tau, q, v)
    expect_close(A[:, : robot.nv], differences(robot, ends, q, v, tau, "q"))
    expect_close(A[:, robot.nv :], differences(robot, ends, q, v, tau, "v"))
    expect_close(B, differences(robot, ends, q, v, tau, "a"))
    assert A.shape == (2 * robot.nv, 2 * robot.nv) and B.shape == (2 * robot.nv, robot.nv)


def test_refuse_what_is_no_state(arm):
    with pytest.raises(ValueError, match="a: found NaN"):
        arm.inverse_dynamics_derivatives(np.full(arm.nv, np.nan))
    with pytest.raises(softgauss.StepError, match="q: found NaN"):
        arm.step_derivatives(q=np.full(arm.nq, np.nan))
