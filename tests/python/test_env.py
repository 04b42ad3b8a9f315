# SPDX-License-Identifier: Apache-2.0
"""Env and VectorEnv."""

import subprocess
import sys

import numpy as np
import pytest
from conftest import ROBOTS

import softgauss

ARM, HUMANOID = ROBOTS / "arm.urdf", ROBOTS / "humanoid.urdf"


def upright(q, v, action):
    return q[:, 2] - 1e-3 * np.square(action).mean(axis=1)


def shaken(random, q, v):
    return q, v + random.normal(scale=0.05, size=v.shape)


HUMANOID_TASK = {
    "reward": upright,
    "duration": 0.2,
    "start": shaken,
    "frame_skip": 4,
    "terminated": lambda q, v: q[:, 2] < 0.5,
}


@pytest.mark.parametrize("action", ["acceleration", "torque"])
def test_each_of_many_is_one_of_its_own(action):
    many = softgauss.VectorEnv(HUMANOID, 3, action=action, threads=2, **HUMANOID_TASK)
    random = np.random.default_rng(4)
    starts = shaken(np.random.default_rng(7), *many._task.starts(np.random.default_rng(7), 3))
    observed, _ = many.reset(seed=7)
    actions = random.normal(scale=5.0, size=(10, 3, 21))
    all_of = [many.step(a) for a in actions]
    for i in range(3):
        one = softgauss.Env(HUMANOID, action=action, **HUMANOID_TASK)
        one.reset(seed=0)
        one.sim.reset()
        one.sim.v = observed[i, one.sim.nq :]
        for frame in range(10):
            mine, reward, over, truncated, _ = one.step(actions[frame, i])
            theirs = [part[i] for part in all_of[frame][:4]]
            assert np.array_equal(mine, theirs[0]) and reward == theirs[1], (i, frame)
            assert (over, truncated) == (theirs[2], theirs[3])
    assert starts[0].shape == (3, many.sim.nq)


def test_an_episode_ends_and_another_begins():
    many = softgauss.VectorEnv(
        ARM,
        2,
        reward=lambda q, v, a: q[:, 0] + 1.0,
        duration=0.05,
        terminated=lambda q, v: v[:, 0] < -0.1,
        action="torque",
    )
    begin, _ = many.reset(seed=1)
    push = np.zeros((2, 7))
    push[1, 0] = -150.0
    frames = many._task.frames
    ended = None
    for frame in range(frames):
        observed, reward, over, truncated, _ = many.step(push)
        if over[1] and ended is None:
            ended = frame
            after = many.step(push)
            assert np.array_equal(after[0][1], begin[1]) and after[1][1] == 0.0 and not after[2][1]
            break
        assert not over[0] and truncated[0] == (frame == frames - 1)
    assert ended is not None


def test_seeds_give_the_same_episodes():
    many = softgauss.VectorEnv(HUMANOID, 2, **HUMANOID_TASK)
    first = many.reset(seed=3)[0]
    assert np.array_equal(first, many.reset(seed=3)[0])
    assert not np.array_equal(first, many.reset(seed=4)[0])
    assert not np.array_equal(first[0], first[1])


def test_goals_can_be_actions():
    env = softgauss.Env(
        ARM,
        action={"reach": {"link": "hand", "target": [0.5, 0, 0.5]}},
        goals=[{"damping": {}}],
        reward=lambda q, v, a: np.zeros(len(q)),
        bounds=([0.2, -0.5, 0.1], [0.7, 0.5, 0.8]),
        duration=10,
    )
    assert env.action_space.shape == (3,) and env.action_space.low.tolist() == [0.2, -0.5, 0.1]
    env.reset()
    for _ in range(200):
        env.step([0.5, 0.2, 0.5])
    assert np.linalg.norm(env.sim.pose("hand")[:3, 3] - [0.5, 0.2, 0.5]) < 0.02
    env.step([9, 9, 9])
    assert env.sim.goals[0].target.tolist() == [0.7, 0.5, 0.8]  # within the bounds


def test_spaces_are_of_the_robot():
    env = softgauss.Env(HUMANOID, action="torque", reward=upright)
    motors = np.array(env.sim.actuated)
    assert np.array_equal(env.action_space.high, env.sim.effort[motors, 1])
    assert (
        env.action_space.sample().shape == (21,) and env.action_space.sample() in env.action_space
    )
    assert env.reset()[0] in env.observation_space
    many = softgauss.VectorEnv(HUMANOID, 4, reward=upright, most_acceleration=30.0)
    assert many.action_space.shape == (4, 21) and many.action_space.high.max() == 30.0
    with pytest.raises(ValueError, match="found 'speed', expected torque, acceleration or goals"):
        softgauss.Env(ARM, action="speed", reward=upright)


def both_environments(action):
    task = {"action": action, "reward": lambda q, v, a: np.ones(len(q))}
    one, many = softgauss.Env(ARM, **task), softgauss.VectorEnv(ARM, 3, **task)
    for env in (one, many):
        env.reset()
    return one, many


@pytest.mark.parametrize("action", ["acceleration", "torque"])
def test_actions_of_another_shape_are_refused(action):
    one, many = both_environments(action)
    for env, shapes in (
        (one, [(1, 7), (6,), (7, 1), ()]),
        (many, [(7, 3), (21,), (7,), (1, 7), (3, 7, 1), (3, 6), ()]),
    ):
        before = env.sim.time, many.states.time.tolist()
        for shape in shapes:
            with pytest.raises(ValueError) as error:
                env.step(np.zeros(shape))
            assert f"found shape {shape}, expected {env.action_space.shape}" in str(error.value)
        assert (env.sim.time, many.states.time.tolist()) == before
        env.step(np.zeros(env.action_space.shape))


def test_a_goal_that_is_to_seek_nan_is_refused_alike():
    one, many = both_environments("acceleration")
    action = np.zeros((3, 7))
    action[1, 4] = np.nan
    with pytest.raises(ValueError, match="action: found NaN or ∞ in row 1, expected finite"):
        many.step(action)
    with pytest.raises(ValueError, match="action: found NaN or ∞ in row 0, expected finite"):
        one.step(action[1])
    assert one.sim.time == 0.0 and not many.states.time.any()
    action[1, 4] = np.inf  # the bound is meant
    many.step(action)
    one.step(action[1])
    assert np.array_equal(one.sim.q, many.states.q[1])


def test_a_torque_of_nan_fails_alike():
    one, many = both_environments("torque")
    action = np.zeros((3, 7))
    action[1, 4] = np.nan
    _, _, over, _, info = many.step(action)
    alone = one.step(action[1])
    assert over.tolist() == [False, True, False] and alone[2]
    assert info["failure"][1] and alone[4]["failure"]


def test_a_refused_step_ends_the_episode():
    many = softgauss.VectorEnv(
        ARM, 2, action="torque", reward=lambda q, v, a: np.ones(len(q)), bounds=(-np.inf, np.inf)
    )
    many.reset()
    actions = np.zeros((2, 7))
    actions[1] = np.nan
    _, _, over, _, info = many.step(actions)
    assert over.tolist() == [False, True] and info["failure"][0] == "" and info["failure"][1]


def test_pushes_and_parameters_are_of_each():
    many = softgauss.VectorEnv(HUMANOID, 2, **HUMANOID_TASK)
    many._task.start = None
    many.reset()
    many.pushes = {"pelvis": np.array([[0.0, 0, 0], [200.0, 0, 0]])}
    many.parameters = {"friction:*": np.array([1.0, 0.5])}
    for _ in range(5):
        observed = many.step(np.zeros((2, 21)))[0]
    assert observed[1, many.sim.nq] > observed[0, many.sim.nq] + 0.05


STAND_IN = """
class Env:
    def reset(self, *, seed=None, options=None):
        self.seeded = seed
class Box:
    def __init__(self, low, high, shape=None, dtype=None, seed=None):
        self.low, self.high, self.shape = low, high, low.shape if shape is None else shape
        self.dtype = dtype
"""


def in_a_process(script, *arguments, path=()):
    """Runs a script in an interpreter of its own, these folders first on its path."""
    first = "import sys\nsys.path[:0] = " + repr([str(folder) for folder in path]) + "\n"
    subprocess.run([sys.executable, "-c", first + script, *arguments], check=True, timeout=120)


def test_without_gymnasium_an_own_box_stands_in():
    in_a_process(
        "sys.modules['gymnasium'] = None\nimport softgauss\n"
        "env = softgauss.Env(sys.argv[1], reward=lambda q, v, a: q[:, 0])\n"
        "assert type(env.action_space) is softgauss.Box\n"
        "env.action_space.seed(1); env.reset(seed=1)\n"
        "env.step(env.action_space.sample())\n",
        ARM,
    )


def test_with_gymnasium_environments_are_its_own(tmp_path):
    """Seen with a stand-in that has gymnasium's shape."""
    package = tmp_path / "gymnasium"
    package.mkdir()
    (package / "__init__.py").write_text(STAND_IN + "from gymnasium import spaces, vector\n")
    (package / "spaces.py").write_text("from gymnasium import Box\n")
    (package / "vector.py").write_text(
        "class VectorEnv: pass\n" "class AutoresetMode: NEXT_STEP = 'next'\n"
    )
    in_a_process(
        "import gymnasium, softgauss\n"
        "env = softgauss.Env(sys.argv[1], reward=lambda q, v, a: q[:, 0])\n"
        "assert isinstance(env, gymnasium.Env)\n"
        "assert isinstance(env.action_space, gymnasium.Box)\n"
        "env.reset(seed=7)\nassert env.seeded == 7\n"
        "many = softgauss.VectorEnv(sys.argv[1], 2, reward=lambda q, v, a: q[:, 0])\n"
        "assert isinstance(many, gymnasium.vector.VectorEnv)\n"
        "assert many.metadata['autoreset_mode'] == 'next'\n",
        ARM,
        path=[tmp_path],
    )


def test_gymnasium_s_own_checks_pass():
    pytest.importorskip("gymnasium")
    in_a_process(
        "import softgauss\nfrom gymnasium.utils.env_checker import check_env\n"
        "env = softgauss.Env(sys.argv[1], reward=lambda q, v, a: q[:, 0])\n"
        "check_env(env, skip_render_check=True)\n",
        ARM,
    )
