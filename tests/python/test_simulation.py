# SPDX-License-Identifier: Apache-2.0
"""Loading, stepping, state, goals, errors."""

import csv
import os
import pathlib
import subprocess
import sys
import threading

import numpy as np
import pytest
from conftest import ROBOTS, SCENES, SOURCE

import softgauss

INTEGRATORS = [
    "leapfrog",
    "semi-implicit-euler",
    "implicit",
    "implicit-midpoint",
    "runge-kutta-4",
    "dormand-prince",
]


def test_three_lines_run_a_robot():
    sim = softgauss.Simulation(ROBOTS / "humanoid.urdf")
    sim.goals.reach("right_hand", [0.45, -0.25, 1.1])
    sim.run(1.0)
    assert np.linalg.norm(sim.pose("right_hand")[:3, 3] - [0.45, -0.25, 1.1]) < 0.05
    assert sim.time == pytest.approx(1.0, abs=1e-12)


def test_names_are_those_of_logs(humanoid):
    assert len(humanoid.q_names) == humanoid.nq and len(humanoid.v_names) == humanoid.nv
    assert humanoid.q_names[3].endswith(".qw") and humanoid.v_names[5].endswith(".wz")
    assert humanoid.joints == humanoid.v_names[6:]
    assert sum(humanoid.actuated) == 21 and np.all(humanoid.effort[:6] == 0.0)
    assert humanoid.mass == pytest.approx(40.9, abs=0.1)
    knee = humanoid.v_names.index("right_knee")
    assert humanoid.range[knee].tolist() == [-0.05, 2.71]
    assert humanoid.effort[knee].tolist() == [-160.0, 160.0]


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_q_v_and_tau_are_views_that_stay(integrator):
    sim = softgauss.Simulation(ROBOTS / "arm.urdf", integrator=integrator)
    q, v, tau = sim.q, sim.v, sim.tau
    saved = sim.save()
    q[1] = 0.3
    tau[0] = 2.0
    assert sim.q[1] == 0.3 and sim.tau[0] == 2.0
    sim.step(3)
    sim.solve()
    sim.solve(q=np.zeros(7))
    sim.step()
    sim.restore(saved)
    sim.step()
    sim.reset()
    sim.q = np.full(7, 0.1)
    sim.step(2)
    assert np.shares_memory(q, sim.q) and np.shares_memory(v, sim.v)
    assert np.array_equal(q, sim.q) and np.array_equal(v, sim.v)
    assert np.shares_memory(tau, sim.tau)


def test_a_view_outlives_the_name_of_its_simulation():
    q = softgauss.Simulation(ROBOTS / "arm.urdf").q
    assert np.all(np.isfinite(q)) and len(q) == 7


def test_the_force_of_the_caller_is_that_of_forward_dynamics(arm):
    arm.tau[:] = np.arange(7) - 3.0
    assert np.array_equal(arm.forward_dynamics(), arm.forward_dynamics(arm.tau.copy()))
    arm.step()
    assert arm.torque("elbow_pitch") == arm.tau[3]


def test_save_and_restore_give_the_same_bits(humanoid, tmp_path):
    humanoid.goals.posture()
    humanoid.step(50)
    saved = humanoid.save()
    humanoid.step(50)
    q, v, time = humanoid.q.copy(), humanoid.v.copy(), humanoid.time
    humanoid.restore(saved)
    humanoid.step(50)
    assert np.array_equal(q, humanoid.q) and np.array_equal(v, humanoid.v) and time == humanoid.time

    (tmp_path / "saved").write_bytes(saved)
    script = (
        "import sys, softgauss\n"
        "sim = softgauss.Simulation(sys.argv[1]); sim.goals.posture()\n"
        "sim.restore(open(sys.argv[2], 'rb').read()); sim.step(50)\n"
        "sys.stdout.write(sim.q.tobytes().hex())"
    )
    other = subprocess.run(
        [sys.executable, "-c", script, ROBOTS / "humanoid.urdf", tmp_path / "saved"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert other.stdout == q.tobytes().hex()


def test_bytes_of_something_else_are_refused(humanoid, arm):
    before = humanoid.q.copy()
    for bad in (b"", arm.save(), humanoid.save()[:-1]):
        with pytest.raises(softgauss.ModelError):
            humanoid.restore(bad)
    assert np.array_equal(before, humanoid.q)


def test_steps_one_by_one_are_steps_at_once(arm):
    arm.goals.reach("hand", [0.5, 0.2, 0.5])
    for _ in range(30):
        arm.step()
    one = arm.q.copy()
    arm.reset()
    arm.step(30)
    assert np.array_equal(one, arm.q)


def test_a_push_is_momentum(tmp_path):
    """A free ball gains the impulse that it is given."""
    scene = tmp_path / "ball.yaml"
    scene.write_text(
        "ground: none\ngravity: [0, 0, 0]\nobjects:\n"
        "  - {name: ball, sphere: {radius: 0.1}, mass: 2, position: [0, 0, 1]}\n"
    )
    sim = softgauss.Simulation(scene)
    sim.push("ball", [3.0, 0, 0])
    sim.step(100)
    sim.push("ball", [0, 0, 0])
    sim.step(10)
    # The engine integrates a constant force exactly, up to rounding of 100 sums.
    assert sim.v[0] == pytest.approx(3.0 / 2.0 * 100 * sim.timestep, rel=1e-12)
    with pytest.raises(softgauss.UnknownName, match="did you mean 'ball'"):
        sim.push("bal", [1, 0, 0])


def test_a_standing_humanoid_is_carried_by_its_feet(humanoid):
    humanoid.goals.posture()
    humanoid.run(1.0)
    feet = humanoid.contact_force("left_foot") + humanoid.contact_force("right_foot")
    assert feet[2] == pytest.approx(humanoid.mass * 9.81, rel=0.02)  # it sways a little still
    contacts = humanoid.contacts
    assert len(contacts) > 0 and contacts.force.shape == (len(contacts), 3)
    assert {link for pair in contacts.links for link in pair} >= {"left_foot", "right_foot"}
    lengths = np.linalg.norm(contacts.normal, axis=1)
    assert np.allclose(lengths, 1.0, rtol=0, atol=1e-12)


# ---- Goals


def test_goals_from_dicts_text_and_file_are_the_same(tmp_path):
    text = (
        "goals:\n  - reach: {link: hand, target: [0.5, 0.3, 0.5], weight: 100}\n  - damping: {}\n"
    )
    (tmp_path / "goals.yaml").write_text(text)
    dicts = [
        {"reach": {"link": "hand", "target": np.array([0.5, 0.3, 0.5]), "weight": 100}},
        {"damping": {}},
    ]
    ends = []
    for give in (
        lambda g: g.add(text),
        lambda g: g.add(dicts),
        lambda g: g.add({"goals": dicts}),
        lambda g: g.read(tmp_path / "goals.yaml"),
        lambda g: [g.add(one)[0] for one in dicts],
    ):
        sim = softgauss.Simulation(ROBOTS / "arm.urdf")
        given = give(sim.goals)
        assert [goal.name for goal in given][0] == "reach hand" and len(sim.goals) == 2
        sim.step(40)
        ends.append(sim.q.copy())
    assert all(np.array_equal(ends[0], end) for end in ends)


def test_a_goal_can_be_moved(arm):
    arm.goals.reach("hand", [0.5, 0.3, 0.5])
    moved = softgauss.Simulation(ROBOTS / "arm.urdf")
    goal = moved.goals.reach("hand", [0.4, 0.0, 0.4])
    goal.target = [0.5, 0.3, 0.5]
    assert goal.target.tolist() == [0.5, 0.3, 0.5]
    arm.step(20)
    moved.step(20)
    assert np.array_equal(arm.q, moved.q)
    moved.goals.clear()
    with pytest.raises(RuntimeError, match="gone"):
        goal.target
    assert len(moved.goals) == 0


def test_accelerations_come_true(arm):
    """The goal of a policy: joints accelerate as told, up to the price of force, 1 in 1000."""
    wished = np.array([1.0, -2.0, 0.5, 1.0, 0.0, 3.0, -1.0])
    (goal,) = arm.goals.add(
        {"acceleration": {"joints": dict.fromkeys(arm.joints, 0.0), "weight": 1e6}}
    )
    goal.target = wished
    assert np.allclose(arm.solve().a, wished, rtol=0, atol=0.02)


@pytest.mark.parametrize(
    "goal, size",
    [
        ({"look_at": {"link": "hand", "target": [1, 0, 0]}}, 3),
        ({"link_acceleration": {"link": "hand", "linear": [0, 0, 1], "angular": [0, 0, 0]}}, 6),
        ({"joint_posture": {"joints": {"elbow_pitch": 0.5}}}, 1),
        ({"joint_velocity": {"joints": {"elbow_pitch": 0.5}}}, 1),
        ({"posture": {}}, 7),
        ({"center_of_mass": {}}, 3),
        ({"momentum": {}}, 6),
        ({"capture_point": {"target": [0, 0, 0]}}, 3),
        ({"contact_force": {"link": "hand", "force": [0, 0, 5]}}, 3),
        ({"center_of_pressure": {"target": [0, 0, 0]}}, 3),
        ({"keep_clear": {"link": "hand", "from": "world", "distance": 0.1}}, 1),
    ],
)
def test_every_kind_has_a_target(goal, size):
    sim = softgauss.Simulation(ROBOTS / "arm.urdf", ground=0.0)
    (added,) = sim.goals.add(goal)
    wished = added.target + 0.25
    added.target = wished
    assert added.target.shape == (size,) and np.array_equal(added.target, wished)
    added.weight = 3.0
    assert added.weight == 3.0


@pytest.mark.parametrize("goal", [{"hold": {"link": "hand"}}, {"damping": {}}, {"effort": {}}])
def test_what_seeks_nothing_has_no_target(arm, goal):
    (added,) = arm.goals.add(goal)
    with pytest.raises(TypeError, match="has no target"):
        added.target
    added.start, added.end, added.weight = 0.5, 1.0, 2.0
    assert (added.start, added.end, added.weight) == (0.5, 1.0, 2.0)


# A target that is moved step by step is followed without lag where its rates are said too.
@pytest.mark.parametrize("with_rates", [True, False])
def test_moved_targets_are_followed(arm, with_rates):
    start, speed = arm.pose("hand")[:3, 3], np.array([0.0, 0.2, 0.0])
    goal, _ = arm.goals.add(
        [{"reach": {"link": "hand", "target": start, "weight": 1e5}}, {"damping": {}}]
    )
    if with_rates:
        goal.velocity, goal.acceleration = speed, np.zeros(3)
        assert np.array_equal(goal.velocity, speed)
    while arm.time < 1.0:
        goal.target = start + arm.time * speed
        arm.step()
    lag = (start + arm.time * speed - arm.pose("hand")[:3, 3])[1]
    assert lag == pytest.approx(0.0 if with_rates else 0.04, abs=0.002)  # v k_d/k_p


def test_a_trajectory_says_where_its_target_is(arm):
    circle = {"center": [0.5, 0, 0.5], "radius": 0.1, "frequency": 0.5}
    (goal,) = arm.goals.add({"reach": {"link": "hand", "trajectory": {"circle": circle}}})
    for name in ("target", "velocity", "acceleration"):
        with pytest.raises(TypeError, match="follows a trajectory"):
            getattr(goal, name)
    goal = arm.goals.reach("hand", [0.5, 0.0, 0.5])  # the same goal, which rests from now on
    assert np.array_equal(goal.target, [0.5, 0.0, 0.5])


# ---- Threads and interrupts


def test_other_threads_run_while_a_simulation_steps(humanoid):
    humanoid.goals.posture()
    stepping = threading.Thread(target=humanoid.step, args=(400,))
    stepping.start()
    refused = 0
    while stepping.is_alive():
        try:
            humanoid.step()
        except RuntimeError as error:
            assert "another thread" in str(error)
            refused += 1
    stepping.join()
    assert refused > 0


def test_control_c_ends_a_long_run():
    script = (
        "import _thread, sys, threading, softgauss\n"
        "sim = softgauss.Simulation(sys.argv[1])\n"
        "threading.Timer(0.3, _thread.interrupt_main).start()\n"
        "try:\n    sim.run(1e5)\n"
        "except KeyboardInterrupt:\n    sys.exit(0 if sim.time > 0 else 1)\nsys.exit(2)"
    )
    ended = subprocess.run([sys.executable, "-c", script, ROBOTS / "arm.urdf"], timeout=60)
    assert ended.returncode == 0


def test_a_scene_brings_its_goals():
    sim = softgauss.Simulation(SCENES / "hand_and_ball.yaml")
    assert len(sim.goals) > 0
    assert (
        len(
            softgauss.Simulation(
                pathlib.Path(SCENES / "hand_and_ball.yaml"), without_goals=True
            ).goals
        )
        == 0
    )


@pytest.mark.parametrize(
    "model, goals",
    [
        (ROBOTS / "humanoid.urdf", SOURCE / "data" / "goals" / "stand_and_reach.yaml"),
        (SCENES / "hand_and_ball.yaml", None),
    ],
)
def test_the_bits_are_those_of_simulate_gdd(tmp_path, model, goals):
    program = pathlib.Path(os.environ.get("SOFTGAUSS_APP_DIR", "")) / "simulate_gdd"
    if not program.is_file():
        pytest.skip("SOFTGAUSS_APP_DIR holds no simulate_gdd")
    log = tmp_path / "log.csv"
    arguments = [model, "--duration", "0.5", "--log", log, "--quiet"]
    subprocess.run(
        [program, *map(str, arguments + (["--goals", goals] if goals else []))], check=True
    )
    with open(log, newline="") as text:
        last = list(csv.DictReader(text))[-1]
    sim = softgauss.Simulation(model)
    if goals:
        sim.goals.read(goals)
    sim.run(0.5)
    assert [float(last["q:" + name]) for name in sim.q_names] == sim.q.tolist()
    assert [float(last["v:" + name]) for name in sim.v_names] == sim.v.tolist()


def test_options_of_the_program_are_keywords(tmp_path):
    arm = softgauss.Simulation(
        ROBOTS / "arm.urdf",
        base="auto",
        exact_diagonal=True,
        step_doubling=True,
        integration_tolerance=1e-5,
        effects="auto",
        without=["supported_mass"],
        zero_effort="unlimited",
        most_dofs=100,
        ground=None,
        package_paths=[tmp_path],
    )
    arm.run(0.01)
    with pytest.raises(TypeError, match="without: found 'parts', expected a list of mechanisms"):
        softgauss.Simulation(ROBOTS / "arm.urdf", without="parts")
    with pytest.raises(TypeError, match="exact_diagonal: found 1, expected True or False"):
        softgauss.Simulation(ROBOTS / "arm.urdf", exact_diagonal=1)


def test_a_reach_follows_the_posture_beside_it(arm):
    goal = arm.goals.reach("hand", [0.5, 0.3, 0.5])
    posture = arm.goals.posture(100.0)
    weight = goal.weight
    posture.weight = 200.0
    assert goal.weight == 2 * weight
    goal.weight = 7.0
    posture.weight = 300.0
    assert goal.weight == 7.0


def test_a_state_of_an_srdf_is_a_start(tmp_path):
    srdf = tmp_path / "arm.srdf"
    srdf.write_text(
        "<robot name='arm'><group_state name='up' group='arm'>"
        "<joint name='elbow_pitch' value='0.4'/></group_state>"
        "<disable_collisions link1='hand' link2='upper_arm'/></robot>"
    )
    by_state = softgauss.Simulation(ROBOTS / "arm.urdf", srdf=srdf, state="up")
    by_position = softgauss.Simulation(ROBOTS / "arm.urdf", q0={"elbow_pitch": 0.4})
    assert np.array_equal(by_state.q, by_position.q)
    with pytest.raises(softgauss.ModelError, match="did you mean 'up'"):
        softgauss.Simulation(ROBOTS / "arm.urdf", srdf=str(srdf), state="upp")
    with pytest.raises(softgauss.ModelError, match="no SRDF in the package"):
        softgauss.Simulation(ROBOTS / "arm.urdf", state="up")
    with pytest.raises(softgauss.OptionError, match="a scene file says it itself"):
        softgauss.Simulation(SCENES / "two_arms.yaml", state="up")
