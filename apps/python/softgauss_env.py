# SPDX-License-Identifier: Apache-2.0
"""Environments for learning, in the shape of gymnasium, which they do without where it is missing.

Env is one robot; VectorEnv is many of the same, stepped on all cores. Both are `softgauss.Env` and
`softgauss.VectorEnv`.
"""

import numpy as np

import softgauss

try:
    import gymnasium
    from gymnasium.spaces import Box
except ImportError:
    gymnasium = None

    class Box:
        """Arrays between two bounds: as much of gymnasium's space of that name as is needed."""

        def __init__(self, low, high, shape=None, dtype=np.float64, seed=None):
            shape = np.broadcast(low, high).shape if shape is None else tuple(shape)
            self.low = np.broadcast_to(low, shape).astype(dtype)
            self.high = np.broadcast_to(high, shape).astype(dtype)
            self.shape, self.dtype = shape, np.dtype(dtype)
            self.seed(seed)

        def seed(self, seed=None):
            self._random = np.random.default_rng(seed)

        def sample(self):
            """Even between finite bounds; normal about 0 or the only bound elsewhere."""
            finite = np.isfinite(self.low) & np.isfinite(self.high)
            low, high = np.where(finite, self.low, 0.0), np.where(finite, self.high, 1.0)
            even = self._random.uniform(low, high)
            wide = np.clip(self._random.normal(size=self.shape), self.low, self.high)
            return np.where(finite, even, wide).astype(self.dtype)

        def contains(self, x):
            x = np.asarray(x)
            return x.shape == self.shape and bool(np.all((self.low <= x) & (x <= self.high)))

        def __contains__(self, x):
            return self.contains(x)

        def __repr__(self):
            return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"


class _Task:
    """What Env and VectorEnv share: the simulation, what actions mean, what is observed."""

    def __init__(
        self,
        model,
        reward,
        *,
        action="acceleration",
        goals=(),
        bounds=None,
        most_acceleration=100.0,
        frame_skip=5,
        duration=5.0,
        observe=None,
        terminated=None,
        start=None,
        **options,
    ):
        self.sim = softgauss.Simulation(model, **options)
        self.q0, self.v0 = self.sim.q.copy(), self.sim.v.copy()
        self.frame_skip, self.reward, self.terminated = int(frame_skip), reward, terminated
        self.dt = self.frame_skip * self.sim.timestep
        self.frames = max(1, round(duration / self.dt))
        self.observe = observe or (lambda q, v: np.concatenate([q, v], axis=-1))
        self.start = start
        self.motors = np.flatnonzero(self.sim.actuated)
        self.torques = isinstance(action, str) and action == "torque"
        low, high = self._set_goals(action, goals, most_acceleration)
        if bounds is not None:
            low, high = (np.broadcast_to(np.asarray(b, float), low.shape) for b in bounds)
        self.action_space = Box(low, high, dtype=np.float64)
        shape = self.observe(self.q0[None], self.v0[None]).shape[1:]
        self.observation_space = Box(-np.inf, np.inf, shape=shape, dtype=np.float64)

    def _set_goals(self, action, goals, most_acceleration):
        """Gives the simulation the goals whose targets actions are, and the others. Returns the
        bounds of actions (k,)."""
        others = [goals] if isinstance(goals, dict) else list(goals)
        own, bound = [], np.inf
        if isinstance(action, str) and action == "acceleration":
            names = [self.sim.v_names[i] for i in self.motors]
            own = [{"acceleration": {"joints": dict.fromkeys(names, 0.0)}}]
            bound = float(most_acceleration)
        elif not isinstance(action, str):
            own = [action] if isinstance(action, dict) else list(action)
        elif not self.torques:
            raise ValueError(f"action: found '{action}', expected torque, acceleration or goals")
        self.goals = own + others
        added = self.sim.goals.add(self.goals) if self.goals else []
        self.seeking = [(goal, len(goal.target)) for goal in added[: len(own)]]
        if self.torques:
            return self.sim.effort[self.motors].T
        size = sum(size for _, size in self.seeking)
        return np.full(size, -bound), np.full(size, bound)

    def clipped(self, action, space):
        """(rows, k), within the bounds. Raises ValueError where its shape is not that of the space,
        and where a goal is to seek NaN or ∞; a torque of NaN is for the step to refuse."""
        action = np.asarray(action, float)
        if action.shape != space.shape:
            raise ValueError(f"action: found shape {action.shape}, expected {space.shape}")
        action = np.clip(action, space.low, space.high).reshape((-1,) + self.action_space.shape)
        bad = np.flatnonzero(~np.isfinite(action).all(axis=1))
        if len(bad) and not self.torques:
            raise ValueError(f"action: found NaN or ∞ in row {bad[0]}, expected finite numbers")
        return action

    def forces(self, action):
        """(rows, nv) generalised forces of torques (rows, k)."""
        tau = np.zeros((len(action), self.sim.nv))
        tau[:, self.motors] = action
        return tau

    def starts(self, random, rows):
        """q (rows, nq) and v (rows, nv) of episodes that begin."""
        q, v = np.tile(self.q0, (rows, 1)), np.tile(self.v0, (rows, 1))
        return (q, v) if self.start is None else self.start(random, q, v)

    def rewards(self, q, v, action, failed):
        """(rows,) rewards, and whether the episode is over: a step that was refused ends it."""
        reward = np.array(self.reward(q, v, action), float).reshape(len(q))
        over = np.array(failed, bool)
        if self.terminated is not None:
            over |= np.asarray(self.terminated(q, v), bool).reshape(len(q))
        return reward, over


class Env(gymnasium.Env if gymnasium else object):
    """A robot in a scene, as gymnasium asks for one.

    model       a .urdf or .yaml file; **options are those of Simulation
    reward      reward(q, v, action) of arrays (n, nq), (n, nv), (n, k) gives (n,)
    action      'acceleration': accelerations (k,) that motors are to bring about [rad/s², m/s²];
                'torque': their torques [N m or N]; or such goals: their targets are actions
    goals       further goals that act besides, a dict or a list of dicts as of Goals.add()
    bounds      (low, high) of actions; by default efforts of motors, or ±most_acceleration
    frame_skip  steps of the simulation for one of the environment
    duration    of an episode [s]; then it is truncated
    observe     observe(q, v) gives (n, m); by default q and v
    terminated  terminated(q, v) gives (n,): the episode is over
    start       start(random, q, v) gives other q (n, nq) and v (n, nv) to begin at
    """

    metadata = {"render_modes": []}

    def __init__(self, model, reward, **task):
        self._task = _Task(model, reward, **task)
        self.sim, self.dt = self._task.sim, self._task.dt
        self.action_space = self._task.action_space
        self.observation_space = self._task.observation_space
        self._random = np.random.default_rng()
        self._frame = 0

    def reset(self, *, seed=None, options=None):
        """Begins an episode. Returns the observation (m,) and a dict."""
        if gymnasium:
            super().reset(seed=seed)
        if seed is not None:
            self._random = np.random.default_rng(seed)
        self.sim.reset()
        q, v = self._task.starts(self._random, 1)
        self.sim.q, self.sim.v = q[0], v[0]
        self._frame = 0
        return self._observed()[0], {}

    def step(self, action):
        """One frame. Returns observation, reward, terminated, truncated and a dict, which holds
        `failure` where a step was refused. Raises ValueError where the action is not (k,), or where a
        goal is to seek NaN."""
        action = self._task.clipped(action, self.action_space)
        if self._task.torques:
            self.sim.tau = self._task.forces(action)[0]
        next_target = 0
        for goal, size in self._task.seeking:
            goal.target = action[0, next_target : next_target + size]
            next_target += size
        info = {}
        try:
            self.sim.step(self._task.frame_skip)
        except softgauss.StepError as error:
            info["failure"] = str(error)
        self._frame += 1
        q, v = self.sim.q[None], self.sim.v[None]
        reward, over = self._task.rewards(q, v, action, np.array(["failure" in info]))
        truncated = self._frame >= self._task.frames
        return self._observed()[0], float(reward[0]), bool(over[0]), truncated, info

    def _observed(self):
        return self._task.observe(self.sim.q[None].copy(), self.sim.v[None].copy())

    def close(self):
        """Nothing is open."""


class VectorEnv(gymnasium.vector.VectorEnv if gymnasium else object):
    """`num_envs` of an Env, stepped on `threads` cores (0: all) by a Rollout, each to the bits of
    an Env of its own. The frame after an episode's last begins the next one: its action counts for
    nothing and its reward is 0.
    """

    metadata = {"render_modes": []}

    def __init__(self, model, num_envs, reward, *, threads=0, **task):
        self._task = _Task(model, reward, **task)
        self.num_envs, self.dt, self.sim = num_envs, self._task.dt, self._task.sim
        self.single_action_space = self._task.action_space
        self.single_observation_space = self._task.observation_space
        self.action_space = self._batch(self.single_action_space)
        self.observation_space = self._batch(self.single_observation_space)
        if gymnasium and hasattr(gymnasium.vector, "AutoresetMode"):
            mode = gymnasium.vector.AutoresetMode.NEXT_STEP
            self.metadata = {**self.metadata, "autoreset_mode": mode}
        self.rollout = softgauss.Rollout(self.sim, threads)
        self.states = softgauss.States(self.sim, num_envs)
        self.pushes = {}  # {link: (num_envs, 3)} forces that act from now on [N]
        self.parameters = {}  # {name: (num_envs,)}, as of Rollout.run()
        self._random = np.random.default_rng()
        self._frame = np.zeros(num_envs, int)
        self._over = np.zeros(num_envs, bool)

    def _batch(self, space):
        shape = (self.num_envs,) + space.shape
        return Box(
            np.broadcast_to(space.low, shape), np.broadcast_to(space.high, shape), dtype=space.dtype
        )

    def _begin(self, rows):
        q, v = self._task.starts(self._random, len(rows))
        self.states.reset(rows, q, v)
        self._frame[rows] = 0
        self._over[rows] = False

    def reset(self, *, seed=None, options=None):
        """Begins all episodes. Returns observations (num_envs, m) and a dict."""
        if seed is not None:
            self._random = np.random.default_rng(seed)
        self._begin(np.arange(self.num_envs))
        return self._observed(), {}

    def step(self, actions):
        """One frame of all. Returns observations (num_envs, m), rewards, terminated and truncated
        (num_envs,) and a dict, which holds `failure` [num_envs] where a step was refused. Raises
        ValueError where actions are not (num_envs, k), or where a goal is to seek NaN."""
        actions = self._task.clipped(actions, self.action_space)
        runs = self._advance(actions)
        failed = np.array([status == "failed" for status in runs.status])
        self._frame += 1
        started = np.flatnonzero(self._over)
        if len(started):
            self._begin(started)
            failed[started] = False
        q, v = self.states.q, self.states.v
        reward, over = self._task.rewards(q, v, actions, failed)
        truncated = self._frame >= self._task.frames
        reward[started], over[started] = 0.0, False
        self._over = over | truncated
        info = {"failure": np.array(runs.failure)} if failed.any() else {}
        return self._task.observe(q, v), reward, over, truncated, info

    def _advance(self, actions):
        held = {"tau": self._task.forces(actions)} if self._task.torques else {"targets": actions}
        return self.rollout.run(
            self._task.frame_skip,
            states=self.states,
            outputs=(),
            goals=self._task.goals or None,
            pushes=self.pushes or None,
            parameters=self.parameters or None,
            **held,
        )

    def _observed(self):
        return self._task.observe(self.states.q, self.states.v)

    def close(self):
        """Nothing is open."""
