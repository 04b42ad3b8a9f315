# SPDX-License-Identifier: Apache-2.0
"""Plans and control that is planned anew."""

import numpy as np
import pytest
from conftest import SOURCE

import softgauss

PLANS = SOURCE / "data" / "plans"


def test_a_plan_is_what_its_controls_cause():
    plan = softgauss.plan(PLANS / "cart_pole.yaml")
    assert plan.q.shape == plan.v.shape == (61, 2)
    assert plan.a.shape == plan.u.shape == (60, 2)
    assert plan.time[-1] == pytest.approx(3.0) and plan.step == 0.05
    assert plan.status == "converged" and plan.root_force == 0.0 and plan.gap < 1e-10
    assert plan.iterations >= len(plan.costs) > 0 and plan.seconds > 0.0
    assert plan.costs[-1] == plan.cost
    assert np.all(np.abs(plan.u[:, 0]) <= 6.0) and np.all(plan.u[:, 1] == 0.0)
    # Knots follow from accelerations, by the leapfrog.
    assert np.allclose(plan.v[1:], plan.v[:-1] + plan.step * plan.a, atol=1e-12)
    mean = 0.5 * (plan.v[1:] + plan.v[:-1])
    assert np.allclose(plan.q[1:], plan.q[:-1] + plan.step * mean, atol=1e-12)
    assert plan.q[-1] == pytest.approx([0.0, np.pi], abs=0.05)


def test_threads_change_no_bit():
    alone, together = (softgauss.plan(PLANS / "hopper.yaml", threads=n) for n in (1, 2))
    assert np.array_equal(alone.q, together.q) and alone.costs == together.costs
    with pytest.raises(softgauss.ModelError, match="threads are 0"):
        softgauss.plan(PLANS / "acrobot.yaml", threads=0)


def test_mpc_swings_up_a_pole_that_is_simulated_elsewhere():
    mpc = softgauss.Mpc(PLANS / "cart_pole.yaml")
    sim = softgauss.Simulation(PLANS / "cart_pole.yaml")
    for _ in range(round(4.5 / mpc.timestep)):
        sim.tau[:] = mpc.update(sim.q, sim.v)
        sim.step()
    assert sim.q == pytest.approx([0.0, np.pi], abs=0.05)
    assert mpc.ticks > 200 and mpc.failed == 0
    assert mpc.cost < mpc.plan.cost and mpc.tick_seconds > 0.0
    assert mpc.time == pytest.approx(4.5 - mpc.timestep)


HAND = {
    "knots": 20,
    "effort": 1e-3,
    "running": {"velocity": 0.02},
    "final": {
        "velocity": 20,
        "points": {"hand": {"target": np.array([0.5, 0.3, 0.5]), "weight": 2000}},
    },
}


def test_a_robot_is_given_its_task_as_a_dict(tmp_path):
    arm = SOURCE / "data" / "robots" / "arm.urdf"
    plan = softgauss.plan(arm, HAND, base="fixed")
    sim = softgauss.Simulation(arm, base="fixed")
    sim.q[:] = plan.q[-1]
    assert sim.pose("hand")[:3, 3] == pytest.approx([0.5, 0.3, 0.5], abs=0.01)
    # As a file says it.
    file = tmp_path / "arm.yaml"
    target = "{hand: {target: [0.5, 0.3, 0.5], weight: 2000}}"
    file.write_text(
        f"robots: [{{urdf: {arm}}}]\nplan: {{knots: 20, effort: 1e-3, running: "
        f"{{velocity: 0.02}}, final: {{velocity: 20, points: {target}}}}}\n"
    )
    assert np.array_equal(softgauss.plan(file).q, plan.q)
    with pytest.raises(softgauss.ModelError, match="task:1.*plan.final.points.*hnd.*did you mean"):
        softgauss.plan(arm, {**HAND, "final": {"points": {"hnd": {}}}}, base="fixed")


def test_targets_move():
    arm = SOURCE / "data" / "robots" / "arm.urdf"
    mpc, sim = softgauss.Mpc(arm, HAND), softgauss.Simulation(arm)
    for target in [0.5, 0.3, 0.5], [0.45, -0.3, 0.4]:
        mpc.move("hand", target)
        for _ in range(round(2.0 / mpc.timestep)):
            sim.tau[:] = mpc.update(sim.q, sim.v)
            sim.step()
        assert sim.pose("hand")[:3, 3] == pytest.approx(target, abs=0.005)
    assert mpc.failed == 0
    with pytest.raises(ValueError, match="found 'elbow', expected one of plan.final.points"):
        mpc.move("elbow", [0, 0, 0])
    with pytest.raises(softgauss.StepError, match="target: found NaN"):
        mpc.move("hand", [0, 0, np.nan])
    cart = softgauss.Mpc(PLANS / "cart_pole.yaml")
    sim = softgauss.Simulation(PLANS / "cart_pole.yaml")
    for sought in [0.0, np.pi], [0.5, np.pi]:
        cart.seek(sought)
        for _ in range(round(5.0 / cart.timestep)):
            sim.tau[:] = cart.update(sim.q, sim.v)
            sim.step()
        assert sim.q == pytest.approx(sought, abs=0.05)


def test_it_is_the_control_of_the_program(tmp_path):
    mpc = softgauss.Mpc(PLANS / "acrobot.yaml")
    again = softgauss.Mpc(PLANS / "acrobot.yaml")
    q, v = mpc.plan.q[3], mpc.plan.v[3]
    assert np.array_equal(mpc.update(q, v, time=0.15), again.update(q, v, time=0.15))


def test_what_is_wrong_is_told():
    with pytest.raises(softgauss.ModelError, match="plan"):
        softgauss.plan(SOURCE / "data" / "scenes" / "two_arms.yaml")
    with pytest.raises(TypeError, match="expected one of base, "):
        softgauss.plan(PLANS / "acrobot.yaml", knots=3)
    with pytest.raises(softgauss.PlanError, match="no plan was found.*try"):
        softgauss.plan(PLANS / "acrobot.yaml", timestep=0.002, q0={"shoulder": 1e9})
    mpc = softgauss.Mpc(PLANS / "acrobot.yaml")
    with pytest.raises(ValueError, match=r"q: found shape \(3,\), expected \(nq,\) = \(2,\)"):
        mpc.update([1, 2, 3], [0, 0])
    with pytest.raises(softgauss.StepError, match="NaN"):
        mpc.update([np.nan, 0], [0, 0])
    with pytest.raises(softgauss.StepError, match="NaN"):
        mpc.update([0, 0], [0, np.inf])
    mpc.update([0, 0], [0, 0], time=1.0)
    with pytest.raises(ValueError, match="time: found 0.5"):
        mpc.update([0, 0], [0, 0], time=0.5)
