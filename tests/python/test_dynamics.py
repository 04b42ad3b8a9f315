# SPDX-License-Identifier: Apache-2.0
"""Forward and inverse dynamics, Jacobians, the controller without a step: laws that they keep."""

import numpy as np
import pytest
from conftest import ROBOTS

import softgauss


def some_state(sim, seed):
    """A configuration and velocity near the start; a quaternion stays unit."""
    random = np.random.default_rng(seed)
    q, v = sim.q.copy(), random.normal(scale=0.5, size=sim.nv)
    joints = sim.nq - len(sim.joints)
    q[joints:] += random.uniform(-0.1, 0.1, len(sim.joints))
    return q, v


@pytest.mark.parametrize("seed", range(5))
def test_inverse_is_the_inverse_of_forward(humanoid, seed):
    q, v = some_state(humanoid, seed)
    tau = np.random.default_rng(seed).normal(scale=20.0, size=humanoid.nv)
    a = humanoid.forward_dynamics(tau, q, v)
    # Newton stops where the gradient is 1e-12 of the forces' scale.
    assert np.allclose(humanoid.inverse_dynamics(a, q, v), tau, rtol=0, atol=1e-7)


@pytest.mark.parametrize("seed", range(5))
def test_p_is_the_derivative_of_inverse_dynamics(humanoid, seed):
    q, v = some_state(humanoid, seed)
    a = humanoid.forward_dynamics(np.zeros(humanoid.nv), q, v)
    P = humanoid.inverse_dynamics_jacobian(a, q, v)
    assert np.array_equal(P, P.T) and np.linalg.eigvalsh(P)[0] > 0
    # Piecewise linear: a small difference stays within a piece, and is then exact up to rounding.
    h = 1e-6
    column = [
        (humanoid.inverse_dynamics(a + h * e, q, v) - humanoid.inverse_dynamics(a - h * e, q, v))
        / (2 * h)
        for e in np.eye(humanoid.nv)
    ]
    assert np.allclose(np.array(column).T, P, rtol=1e-5, atol=1e-3 * np.abs(P).max())


def test_free_of_contacts_p_is_the_mass_matrix():
    sim = softgauss.Simulation(ROBOTS / "humanoid.urdf", ground=None, base_height=5.0)
    sim.step()
    P = sim.inverse_dynamics_jacobian(np.zeros(sim.nv))
    M = sim.mass_matrix()
    added = np.diag(P - M)
    # Joint damping is implicit: it adds to the diagonal, and to nothing else.
    assert np.allclose(P - M, np.diag(added), rtol=0, atol=1e-12) and np.all(added >= -1e-12)
    assert np.allclose(M[:3, :3], sim.mass * np.eye(3), rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    "link, point", [("right_hand", (0, 0, 0)), ("left_foot", (0.1, 0.02, -0.03))]
)
def test_a_jacobian_is_the_derivative_of_a_pose(humanoid, link, point):
    q, _ = some_state(humanoid, 3)
    J = humanoid.jacobian(link, point, q)
    assert J.shape == (6, humanoid.nv)
    h = 1e-6
    local = np.append(point, 1.0)
    for i in range(6, humanoid.nv):  # joints: q and v have the same entries
        places = []
        for sign in (h, -h):
            at = q.copy()
            at[i + 1] += sign
            humanoid.q = at
            places.append(humanoid.pose(link) @ local)
        assert np.allclose((places[0] - places[1])[:3] / (2 * h), J[:3, i], rtol=0, atol=1e-8)
    assert np.array_equal(J[:3, :3], np.eye(3))


def test_the_virtual_work_of_a_push_is_that_of_its_torque(arm):
    """Jᵀf as a generalised force does what the force f does."""
    f = np.array([3.0, -2.0, 5.0])
    tau = arm.jacobian("hand")[:3].T @ f
    by_torque = arm.forward_dynamics(tau)
    arm.push("hand", f)
    arm.step()
    pushed = softgauss.Simulation(ROBOTS / "arm.urdf")
    pushed.tau = tau
    pushed.step()
    # The same force over one step, from rest: the arm turns by 1e-5 rad meanwhile.
    assert np.allclose(arm.v, pushed.v, rtol=1e-3, atol=1e-9)
    assert np.abs(by_torque).max() > 1.0


def test_what_is_asked_elsewhere_leaves_the_state(humanoid):
    humanoid.goals.posture()
    humanoid.step(20)
    twin = softgauss.Simulation(ROBOTS / "humanoid.urdf")
    twin.goals.posture()
    twin.step(20)
    q, v = some_state(humanoid, 1)
    humanoid.solve(q, v)
    humanoid.solve()
    a = humanoid.forward_dynamics(np.zeros(humanoid.nv), q, v)
    humanoid.inverse_dynamics_jacobian(a)
    humanoid.mass_matrix(q)
    humanoid.jacobian("right_hand", q=q)
    humanoid.step(20)
    twin.step(20)
    assert np.array_equal(humanoid.q, twin.q) and np.array_equal(humanoid.v, twin.v)


def test_an_answer_at_a_given_state_depends_on_it_alone(humanoid):
    humanoid.goals.posture()
    q, v = some_state(humanoid, 2)
    first = humanoid.solve(q, v)
    humanoid.step(30)
    second = humanoid.solve(q, v)
    assert np.array_equal(first.tau, second.tau) and np.array_equal(first.a, second.a)


def test_the_controller_s_answer_is_one_that_motors_can_give(humanoid):
    humanoid.goals.reach("right_hand", [0.45, -0.25, 1.1])
    humanoid.goals.posture()
    s = humanoid.solve()
    assert s.certified and s.status in ("converged", "kink")
    low, high = humanoid.effort.T
    assert np.all(s.tau >= low) and np.all(s.tau <= high) and np.all(s.tau[:6] == 0.0)
    weight = humanoid.mass * 9.81
    assert len(s.contacts) > 0
    up = sum(
        f[2] for pair, f in zip(s.contacts.links, s.contacts.force) if pair[1].endswith("foot")
    )
    up -= sum(
        f[2] for pair, f in zip(s.contacts.links, s.contacts.force) if pair[0].endswith("foot")
    )
    # Newton's law for the whole: the ground's force is what accelerates it and carries it.
    M = humanoid.mass_matrix()
    assert up == pytest.approx(weight + (M @ s.a)[2], rel=1e-6)


def test_wrong_shapes_are_told(arm):
    with pytest.raises(ValueError, match=r"a: found shape \(3,\)"):
        arm.inverse_dynamics([1, 2, 3])
    with pytest.raises(ValueError, match="finite"):
        arm.inverse_dynamics([np.nan] * 7)
    with pytest.raises(softgauss.UnknownName):
        arm.jacobian("nothing")
    with pytest.raises(softgauss.StepError):
        arm.forward_dynamics(q=[np.nan] * 7)


@pytest.mark.parametrize("found, said", [(0.0, r"quaternion \(0, 0, 0, 0\)"), (np.nan, "NaN")])
def test_what_is_no_configuration_is_refused_as_the_step_does(humanoid, found, said):
    good = humanoid.q.copy()
    bad = good.copy()
    bad[3:7] = found
    zero = np.zeros(humanoid.nv)
    asked = [
        lambda **at: humanoid.forward_dynamics(zero, **at),
        lambda **at: humanoid.inverse_dynamics(zero, **at),
        lambda **at: humanoid.inverse_dynamics_jacobian(zero, **at),
        lambda **at: humanoid.solve(**at),
        lambda **at: humanoid.mass_matrix(**at),
        lambda **at: humanoid.jacobian("torso", **at),
    ]
    for ask in asked:
        with pytest.raises(softgauss.StepError, match=said + ".* at joint 'pelvis'"):
            ask(q=bad)
        assert np.array_equal(humanoid.q, good)
        ask(q=3.0 * good)  # of any other length it is a rotation
    humanoid.q = bad
    for ask in [*asked, lambda: humanoid.pose("torso"), humanoid.step]:
        with pytest.raises(softgauss.StepError):
            ask()
    humanoid.q = good
    humanoid.step()
