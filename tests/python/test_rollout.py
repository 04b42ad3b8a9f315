# SPDX-License-Identifier: Apache-2.0
"""Many runs: the bits of single ones, whatever the threads; errors; interrupts."""

import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import ROBOTS

import softgauss

HUMANOID, ARM = ROBOTS / "humanoid.urdf", ROBOTS / "arm.urdf"
REACH = [{"reach": {"link": "hand", "target": [0.5, 0.2, 0.5]}}, {"damping": {}}]


def some_runs(threads, runs=6):
    sim = softgauss.Simulation(HUMANOID)
    random = np.random.default_rng(1)
    q0 = np.tile(sim.q, (runs, 1))
    q0[:, 2] += 0.01 * np.arange(runs)
    outputs = ("q", "v", "a", "tau", "contact_forces")
    return (
        softgauss.Rollout(sim, threads).run(
            40,
            q0=q0,
            parameters={"friction:*": random.uniform(0.2, 1, runs), "damping:right_knee": 0.5},
            goals={"posture": {}},
            pushes={"pelvis": random.normal(scale=30, size=(runs, 3))},
            outputs=outputs,
            every=10,
        ),
        sim,
    )


def test_the_bits_are_the_same_for_any_number_of_threads():
    one, sim = some_runs(1)
    assert one.status == ["completed"] * 6 and one.steps.tolist() == [40] * 6
    assert one.q.shape == (6, 4, sim.nq) and one.v.shape == (6, 4, sim.nv)
    links = softgauss.Rollout(sim).contact_links
    assert one.contact_forces.shape == (6, 4, len(links), 3)
    for threads in (2, 7):
        other, _ = some_runs(threads)
        for name in ("q", "v", "a", "tau", "contact_forces"):
            assert np.array_equal(getattr(one, name), getattr(other, name)), (name, threads)
    assert not np.array_equal(one.q[0], one.q[1])


def test_goals_of_the_simulation_are_not_lost_in_silence():
    sim = softgauss.Simulation(HUMANOID)
    rollout = softgauss.Rollout(sim)
    rollout.run(2, runs=1)
    sim.goals.posture()
    with pytest.raises(ValueError, match="goals of the simulation"):
        rollout.run(2, runs=1)
    rollout.run(2, runs=1, goals={"posture": {}})
    rollout.run(2, runs=1, goals=[])
    sim.goals.clear()
    with pytest.raises(ValueError, match="goals of the simulation"):
        rollout.run(2, runs=1)


def test_a_run_is_what_a_simulation_does():
    sim = softgauss.Simulation(HUMANOID)
    sim.goals.add({"posture": {}})
    sim.push("pelvis", [20.0, 5.0, 0.0])
    sim.step(30)
    runs = softgauss.Rollout(softgauss.Simulation(HUMANOID)).run(
        30, runs=2, goals={"posture": {}}, pushes={"pelvis": [[20.0, 5.0, 0.0]] * 2}, every=30
    )
    for run in range(2):
        assert np.array_equal(runs.q[run, 0], sim.q) and np.array_equal(runs.v[run, 0], sim.v)


def test_forces_of_every_step_or_held():
    sim = softgauss.Simulation(ARM)
    tau = np.random.default_rng(2).normal(scale=5, size=(3, sim.nv))
    rollout = softgauss.Rollout(sim)
    held = rollout.run(20, tau=tau, every=20)
    each = rollout.run(20, tau=np.repeat(tau[:, None], 20, axis=1), every=20)
    assert np.array_equal(held.q, each.q)
    sim.tau = tau[1]
    sim.step(20)
    assert np.array_equal(held.q[1, 0], sim.q)


def test_targets_are_those_of_the_first_goals():
    sim = softgauss.Simulation(ARM)
    targets = np.array([[0.5, 0.2, 0.5], [0.4, -0.2, 0.4]])
    runs = softgauss.Rollout(sim).run(30, targets=targets, goals=REACH, every=30)
    assert not np.array_equal(runs.q[0], runs.q[1])
    sim.goals.add(REACH)[0].target = targets[1]
    sim.step(30)
    assert np.array_equal(runs.q[1, 0], sim.q)
    assert np.array_equal(
        runs.q,
        softgauss.Rollout(sim)
        .run(
            30,
            parameters={f"reach:hand.{axis}": targets[:, i] for i, axis in enumerate("xyz")},
            goals=REACH,
            every=30,
        )
        .q,
    )


def test_runs_go_on_from_states_to_the_same_bits():
    sim = softgauss.Simulation(HUMANOID)
    sim.goals.posture()
    rollout, goals = softgauss.Rollout(sim), {"posture": {}}
    pushes = {"pelvis": np.array([[10.0, 0, 0], [0, 40.0, 0], [0, 0, 0]])}
    whole = rollout.run(60, runs=3, goals=goals, pushes=pushes, every=60)
    states = softgauss.States(softgauss.Simulation(HUMANOID), 3)
    with pytest.raises(ValueError, match="another simulation"):
        rollout.run(1, states=states)
    states = softgauss.States(sim, 3)
    for steps in (1, 19, 40):
        rollout.run(steps, states=states, goals=goals, pushes=pushes, outputs=())
    assert np.array_equal(whole.q[:, 0], states.q) and np.array_equal(whole.v[:, 0], states.v)
    assert states.time.tolist() == [60 * sim.timestep] * 3
    assert states.nbytes / 3 < 10000  # a hundred thousand humanoids fit into 1 GB

    states.reset([1], sim.q[None])
    assert states.time.tolist() == [60 * sim.timestep, 0.0, 60 * sim.timestep]
    assert np.array_equal(states.q[1], sim.q) and not states.v[1].any()


def test_states_begin_where_the_simulation_is():
    sim = softgauss.Simulation(HUMANOID)
    sim.goals.add({"posture": {}})
    sim.step(25)
    states = softgauss.States(sim, 2)
    softgauss.Rollout(sim).run(10, states=states, goals={"posture": {}})
    sim.step(10)
    assert np.array_equal(states.q[0], sim.q) and np.array_equal(states.q[1], sim.q)
    assert states.time[0] == sim.time


def test_a_failing_run_costs_only_itself_and_tells_why():
    sim = softgauss.Simulation(ARM)
    tau = np.zeros((3, 10, sim.nv))
    tau[1, 4, 0] = np.nan
    runs = softgauss.Rollout(sim).run(10, tau=tau)
    assert runs.status == ["completed", "failed", "completed"]
    assert runs.steps.tolist() == [10, 4, 10] and sim.joints[0] in runs.failure[1]
    assert np.isfinite(runs.q[1, :4]).all() and np.isnan(runs.q[1, 4:]).all()
    assert np.array_equal(runs.q[0], runs.q[2])


def test_wrong_arguments_are_told():
    sim = softgauss.Simulation(ARM)
    rollout = softgauss.Rollout(sim)
    with pytest.raises(
        ValueError, match=r"q0: found shape \(2, 3\), expected \(runs, nq\) = \(2, 7\)"
    ):
        rollout.run(1, q0=np.zeros((2, 3)))
    with pytest.raises(softgauss.UnknownName, match="did you mean 'elbow_pitch'"):
        rollout.run(1, runs=2, parameters={"damping:elbow_pich": 1.0})
    with pytest.raises(softgauss.UnknownName, match="push: found 'hnd'"):
        rollout.run(1, pushes={"hnd": np.zeros((2, 3))})
    with pytest.raises(softgauss.ModelError, match="unknown kind"):
        rollout.run(1, runs=1, goals={"raech": {}})
    with pytest.raises(ValueError, match=r"targets: found shape \(2, 4\), expected .* \(2, 3\)"):
        rollout.run(1, goals=REACH, targets=np.zeros((2, 4)))
    with pytest.raises(ValueError, match="output 'x', expected some of q, v"):
        rollout.run(1, runs=1, outputs=["x"])
    with pytest.raises(TypeError, match="how many runs"):
        rollout.run(1)
    with pytest.raises(ValueError, match="none below"):
        rollout.run(1, runs=1, every=0)
    runs = rollout.run(1, parameters={"mass:hand": [1.0, -1.0]})
    assert runs.status == ["completed", "failed"] and "mass:hand" in runs.failure[1]


@pytest.mark.parametrize(
    "given, said",
    [
        ({"runs": 3.0}, "runs: found 3.0, expected a whole number"),
        ({"runs": "3"}, "runs: found '3', expected a whole number"),
        ({"runs": 10**30}, "runs: found 1000.*, expected a whole number"),
        ({"parameters": {3: [1.0]}}, "parameters: found 3, expected a name"),
        ({"runs": 1, "parameters": {None: 1.0}}, "parameters: found None, expected a name"),
        ({"runs": 1, "parameters": [1.0]}, r"parameters: found \[1.0\], expected a dict"),
        ({"pushes": {("hand", 0): [[0, 0, 1]]}}, r"pushes: found \('hand', 0\), expected a name"),
        ({"runs": 1, "pushes": 7}, "pushes: found 7, expected a dict"),
    ],
)
def test_values_of_another_type_are_told_in_words(given, said):
    with pytest.raises(TypeError, match=said):
        softgauss.Rollout(softgauss.Simulation(ARM)).run(1, **given)


def test_rows_are_indices_or_a_mask():
    sim = softgauss.Simulation(ARM)
    for rows, chosen in (
        ([2, 0], [2, 0]),
        (np.array([3]), [3]),
        ([], []),
        ([False, False, True, False], [2]),
        (np.array([True, False, False, True]), [0, 3]),
        (np.zeros(4, bool), []),
        (None, [0, 1, 2, 3]),
    ):
        states = softgauss.States(sim, 4)
        states.reset(rows, q=np.arange(1, len(chosen) + 1)[:, None] * np.full(7, 0.1))
        expected = np.tile(sim.q, (4, 1))
        for k, row in enumerate(chosen):
            expected[row] = 0.1 * (k + 1)
        assert np.allclose(states.q, expected, rtol=0, atol=1e-15), rows
    for wrong in ([True, False], [1.0, 2.0], [[0, 1]], 1, "01", [None]):
        with pytest.raises(TypeError, match="rows: found .*, expected indices or a mask"):
            states.reset(wrong)
    with pytest.raises(IndexError, match="found row 4, there are 4"):
        states.reset([4])


def test_the_interpreter_s_lock_is_released():
    rollout = softgauss.Rollout(softgauss.Simulation(HUMANOID), 1)
    work = threading.Thread(target=rollout.run, args=(1000,), kwargs={"runs": 8})
    work.start()
    turns = 0
    while work.is_alive():
        turns += 1
        time.sleep(0.001)
    assert turns > 20


def test_progress_is_told_and_may_end_it():
    rollout = softgauss.Rollout(softgauss.Simulation(ARM), 1)
    told = []
    rollout.run(100, runs=4, progress=lambda done, runs: told.append((done, runs)))
    assert told[-1] == (4, 4)

    def enough(done, runs):
        raise StopIteration("enough")

    with pytest.raises(StopIteration, match="enough"):
        rollout.run(10**7, runs=4, outputs=(), progress=enough)
    assert rollout.run(2, runs=1).status == ["completed"]  # it can be used again


def test_control_c_ends_a_rollout():
    script = (
        "import _thread, sys, threading, softgauss\n"
        "rollout = softgauss.Rollout(softgauss.Simulation(sys.argv[1]))\n"
        "threading.Timer(0.3, _thread.interrupt_main).start()\n"
        "try:\n    rollout.run(10**8, runs=2, outputs=())\n"
        "except KeyboardInterrupt:\n    sys.exit(0)\nsys.exit(2)"
    )
    assert subprocess.run([sys.executable, "-c", script, ARM], timeout=60).returncode == 0


def test_states_belong_to_one_thread_at_a_time():
    """A second rollout and every look at the states are refused while a first one has them."""
    sim = softgauss.Simulation(HUMANOID)
    states = softgauss.States(sim, 4)
    first, second = softgauss.Rollout(sim, 1), softgauss.Rollout(sim, 1)
    refused = []

    def meanwhile(done, runs):
        for use in (
            lambda: second.run(1, states=states),
            lambda: states.q,
            lambda: states.v,
            lambda: states.time,
            lambda: states.nbytes,
            states.reset,
        ):
            try:
                use()
            except RuntimeError as error:
                refused.append("another thread uses these states" in str(error))
        raise StopIteration

    with pytest.raises(StopIteration):
        first.run(10**7, states=states, outputs=(), progress=meanwhile)
    assert refused == [True] * 6
    states.reset()
    assert second.run(2, states=states).status == ["completed"] * 4  # it is free again
    assert states.time.tolist() == [2 * sim.timestep] * 4
