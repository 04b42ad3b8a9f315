# SPDX-License-Identifier: Apache-2.0
"""What a state has: laws between energy, momentum, centre of mass, bias forces and their rates."""

import numpy as np
import pytest
from test_dynamics import some_state

H = 1e-6  # [s] of a central difference: truncation and rounding are near 1e-9


def rate(sim, f, q, v):
    """Of f(q) along v."""
    return (np.array(f(sim.integrate(q, v, H))) - np.array(f(sim.integrate(q, v, -H)))) / (2 * H)


@pytest.mark.parametrize("seed", range(3))
def test_integrate_and_difference_are_inverses(humanoid, seed):
    q, v = some_state(humanoid, seed)
    there = humanoid.integrate(q, v, 0.3)
    assert np.allclose(humanoid.difference(q, there), 0.3 * v, rtol=0, atol=1e-12)
    assert abs(np.linalg.norm(there[3:7]) - 1.0) < 1e-14


@pytest.mark.parametrize("seed", range(3))
def test_momentum_is_mass_times_the_rate_of_the_centre_of_mass(humanoid, seed):
    q, v = some_state(humanoid, seed)
    moves = rate(humanoid, humanoid.center_of_mass, q, v)
    assert np.allclose(humanoid.center_of_mass_jacobian(q) @ v, moves, rtol=0, atol=1e-7)
    assert np.allclose(humanoid.momentum(q, v)[:3], humanoid.mass * moves, rtol=0, atol=1e-5)


@pytest.mark.parametrize("seed", range(3))
def test_angular_momentum_is_the_gradient_of_kinetic_energy(humanoid, seed):
    # T = ½ vᵀ M v, and turning the whole robot about its centre of mass by ω changes T by kᵀ ω.
    q, v = some_state(humanoid, seed)
    T, _ = humanoid.energy(q, v)
    assert T == pytest.approx(0.5 * v @ humanoid.mass_matrix(q) @ v, rel=1e-12)
    turn = np.zeros((humanoid.nv, 3))
    # Of the floating base: the velocity of its origin in the world, its turning in its own axes.
    turn[3:6] = np.eye(3)
    J = humanoid.jacobian(humanoid.links[0], q=q)
    about = J @ turn  # what unit turning of the base does in the world
    com = humanoid.center_of_mass_jacobian(q) @ turn
    for i in range(3):
        whole = turn[:, i].copy()
        whole[:3] -= com[:, i]  # the centre of mass rests
        change = humanoid.energy(q, v + H * whole)[0] - humanoid.energy(q, v - H * whole)[0]
        k = humanoid.momentum(q, v)[3:]
        assert change / (2 * H) == pytest.approx(k @ about[3:, i], abs=1e-5)


@pytest.mark.parametrize("seed", range(3))
def test_bias_forces_do_what_energy_says(arm, seed):
    q, v = some_state(arm, seed)
    power = rate(arm, lambda at: arm.energy(at, np.zeros(arm.nv))[1], q, v)
    assert arm.bias_forces(q, np.zeros(arm.nv)) @ v == pytest.approx(power, abs=1e-6)
    # vᵀ (C v) = ½ vᵀ Ṁ v
    turning = arm.bias_forces(q, v) - arm.bias_forces(q, np.zeros(arm.nv))
    assert turning @ v == pytest.approx(0.5 * v @ rate(arm, arm.mass_matrix, q, v) @ v, abs=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_motion_of_links_is_the_rate_of_where_they_are(humanoid, seed):
    link, point = "right_hand", [0.05, -0.02, 0.1]
    q, v = some_state(humanoid, seed)
    moves = humanoid.link_velocity(link, point, q, v)
    assert np.allclose(humanoid.jacobian(link, point, q) @ v, moves, rtol=0, atol=1e-12)

    def place(at):
        humanoid.q = at
        pose = humanoid.pose(link)
        return pose[:3, :3] @ point + pose[:3, 3]

    assert np.allclose(rate(humanoid, place, q, v), moves[:3], rtol=0, atol=1e-7)
    # J̇ v, where v goes on as it is.
    turns = rate(humanoid, lambda at: humanoid.link_velocity(link, point, at, v), q, v)
    bias = humanoid.link_bias_acceleration(link, point, q, v)
    assert np.allclose(turns, bias, rtol=0, atol=1e-6)
    with pytest.raises(LookupError, match="link_velocity: .*right_hand"):
        humanoid.link_velocity("right_hnd")
