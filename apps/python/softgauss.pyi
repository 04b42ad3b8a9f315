# SPDX-License-Identifier: Apache-2.0
"""Soft-constraint rigid-body physics with goal directed dynamics.

SI units and radians; world axes with z up; quaternions are w first. The velocity of a floating base
is the world velocity of its origin, then its angular velocity in its own axes.
"""

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from softgauss_env import Box as Box, Env as Env, VectorEnv as VectorEnv

Array = NDArray[np.float64]
Path = str | os.PathLike[str]
Given = ArrayLike | None
GoalDict = Mapping[str, Mapping[str, Any]]
Goals_ = str | GoalDict | Sequence[GoalDict]

__version__: str

class ModelError(ValueError):
    """A model, scene or goal that cannot be simulated."""
class OptionError(ValueError):
    """An option that does not fit what is loaded."""
class UnknownName(LookupError):
    """A link, joint or parameter that the model lacks, with the nearest that it has."""
class StepError(ArithmeticError):
    """A step that was refused: the time, the joint, the deepest contact."""
class PlanError(ArithmeticError):
    """No plan that the actuators can cause was found: what is left, and what to try."""

class Goal:
    """A goal of a simulation, until it is removed."""
    target: Array
    velocity: Array  # of the target that is moved step by step
    acceleration: Array
    weight: float
    stiffness: float  # [1/s²], damping and rate [1/s]: of those goals that have them
    damping: float
    rate: float
    start: float
    end: float
    @property
    def name(self) -> str: ...
    def held_back(self) -> list[tuple[str, float]]:
        """What holds it back now, and its share: the largest first, they add up to 1."""
    def remove(self) -> None:
        """It acts no more; what came with it stays."""

class Goals:
    """The goals of a simulation. Reach, hold and posture come with virtual damping."""
    def reach(
        self,
        link: str,
        target: ArrayLike,
        point: ArrayLike = (0, 0, 0),
        weight: float | None = None,
    ) -> Goal:
        """A point (3,) of the link [m] seeks a place (3,) in the world [m]; again: another."""
    def hold(self, link: str) -> Goal:
        """The link stays where and as it is."""
    def posture(self, weight: float = 1000.0) -> Goal:
        """All joints and bases seek the configuration of the start."""
    def add(self, goals: Goals_) -> list[Goal]:
        """Any goals of docs/reference/goals.md: YAML text, a dict {kind: {key: value}} or a list of them."""
    def read(self, file: Path) -> list[Goal]:
        """The same from a YAML file."""
    def clear(self) -> None: ...
    def __len__(self) -> int: ...
    def __getitem__(self, i: int) -> Goal: ...
    def __delitem__(self, i: int) -> None: ...

class Contacts:
    """Contacts, one a row, world axes."""
    @property
    def links(self) -> list[tuple[str, str]]: ...
    @property
    def point(self) -> Array:
        """(n, 3) [m]"""
    @property
    def normal(self) -> Array:
        """(n, 3) unit, from the first link to the second"""
    @property
    def force(self) -> Array:
        """(n, 3) on the second link [N]"""
    def __len__(self) -> int: ...

class Solution:
    """What the controller answers to a state."""

    @property
    def tau(self) -> Array:
        """(nv,) [N m or N]"""
    @property
    def a(self) -> Array:
        """(nv,) [rad/s² or m/s²]"""
    @property
    def contacts(self) -> Contacts: ...
    @property
    def certified(self) -> bool: ...
    @property
    def status(self) -> str: ...
    @property
    def stationarity(self) -> float: ...
    @property
    def violation(self) -> float: ...
    @property
    def objective(self) -> float: ...
    @property
    def iterations(self) -> int: ...

class Plan:
    """A motion that was planned: N + 1 states, N controls between them."""

    q: Final[Array]
    v: Final[Array]
    a: Final[Array]
    u: Final[Array]
    time: Final[Array]
    step: Final[float]
    cost: Final[float]
    costs: Final[list[float]]
    status: Final[str]
    root_force: Final[float]
    gap: Final[float]
    certificate: Final[float]
    iterations: Final[int]
    seconds: Final[float]

class Mpc:
    """Control by a plan that is made anew from the present state, at plan.mpc.rate."""

    def __init__(
        self, file: Path, task: dict[str, Any] | None = None, *, threads: int = 1, **options: Any
    ) -> None: ...
    def update(self, q: ArrayLike, v: ArrayLike, time: float | None = None) -> Array:
        """The control (nv,) at q (nq,) and v (nv,)."""
    def move(self, link: str, target: ArrayLike) -> None:
        """The place to which the plan's point of a link is to come [m]."""
    def seek(self, q: ArrayLike) -> None:
        """The configuration (nq,) in which the plan is to end at rest."""
    @property
    def plan(self) -> Plan: ...
    @property
    def timestep(self) -> float: ...
    @property
    def time(self) -> float: ...
    @property
    def ticks(self) -> int: ...
    @property
    def failed(self) -> int: ...
    @property
    def tick_seconds(self) -> float: ...
    @property
    def cost(self) -> float: ...

def plan(
    file: Path, task: dict[str, Any] | None = None, *, threads: int = 1, **options: Any
) -> Plan:
    """Plans what the key plan of a scene, or `task`, asks for; options as of Simulation."""

class Simulation:
    """A URDF or a scene that is ready to run, with its goals and the defaults of simulate_gdd."""

    q: Array  # (nq,) a view [rad or m; a base: x y z qw qx qy qz]
    v: Array  # (nv,) a view [rad/s or m/s]
    tau: Array  # (nv,) a view: force besides the controller [N m or N]

    def __init__(
        self,
        file: Path,
        *,
        base: Literal["fixed", "floating", "auto"] = ...,
        base_height: float = ...,
        ground: float | None = ...,
        timestep: float = ...,
        q0: Mapping[str, float] = ...,
        srdf: Path = ...,
        state: str = ...,
        integrator: str = ...,
        integration_tolerance: float = ...,
        cone: Literal["pyramidal", "elliptic"] = ...,
        gdd_solver: Literal["active-set", "augmented-lagrangian"] = ...,
        control_cost: Literal["about-gravity", "total"] = ...,
        budget: int | str = ...,
        meshes: Literal["auto", "hull", "triangles"] = ...,
        collision: Literal["own", "fcl"] = ...,
        compatibility: Literal["none", "mujoco"] = ...,
        step_doubling: bool = ...,
        sleep: Literal["none", "objects", "all"] = ...,
        exact_diagonal: bool = ...,
        effects: Literal["auto", "none"] | Sequence[str] = ...,
        without: Sequence[str] = ...,
        zero_effort: Literal["passive", "unlimited"] = ...,
        infer_inertia: bool = ...,
        most_dofs: int = ...,
        ignore_velocity_limits: bool = ...,
        no_balance: bool = ...,
        package_paths: Sequence[Path] = ...,
        without_goals: bool = ...,
        without_servos: bool = ...,
        visual_meshes: bool = ...,
    ) -> None: ...
    @property
    def goals(self) -> Goals: ...
    def step(self, n: int = 1) -> None: ...
    def run(self, seconds: float) -> None: ...
    def reset(self) -> None: ...
    def save(self) -> bytes: ...
    def restore(self, saved: bytes) -> None: ...
    def record(self) -> None: ...
    def save_replay(self, file: Path) -> None: ...
    def stand_on_ground(self) -> None: ...
    @property
    def time(self) -> float: ...
    @property
    def a(self) -> Array:
        """(nv,) of the last step [rad/s² or m/s²]"""
    def position(self, joint: str) -> float: ...
    def velocity(self, joint: str) -> float: ...
    def set_position(self, joint: str, q: float) -> None: ...
    def set_velocity(self, joint: str, v: float) -> None: ...
    def set_set_point(self, joint: str, set_point: float, rate: float = 0.0) -> None:
        """Of its servo [rad or m, rad/s or m/s]"""
    def set_point(self, joint: str) -> float:
        """With which its servo makes the force of the last step [rad or m]"""
    def asleep(self, link: str) -> bool: ...
    def wake(self, link: str) -> None: ...
    def pose(self, link: str) -> Array:
        """(4, 4) in the world, now"""
    def torque(self, joint: str) -> float:
        """Of the last step [N m or N]."""
    def contact_force(self, link: str) -> Array:
        """(3,) on the link in the last step, world [N]"""
    def push(
        self,
        link: str,
        force: ArrayLike,
        moment: ArrayLike = (0, 0, 0),
        point: ArrayLike = (0, 0, 0),
    ) -> None:
        """Force (3,) [N] and moment (3,) [N m] in every step from now on; zero: nothing."""
    @property
    def contacts(self) -> Contacts: ...
    def solve(self, q: Given = None, v: Given = None) -> Solution:
        """The controller without a step, at q (nq,) and v (nv,) or at the present ones."""
    def forward_dynamics(self, tau: Given = None, q: Given = None, v: Given = None) -> Array:
        """(nv,) acceleration under tau (nv,)"""
    def inverse_dynamics(self, a: ArrayLike, q: Given = None, v: Given = None) -> Array:
        """(nv,) force under which the acceleration is a (nv,)"""
    def inverse_dynamics_jacobian(self, a: ArrayLike, q: Given = None, v: Given = None) -> Array:
        """(nv, nv) P = ∂τ/∂a"""
    def mass_matrix(self, q: Given = None) -> Array:
        """(nv, nv)"""
    def jacobian(self, link: str, point: ArrayLike = (0, 0, 0), q: Given = None) -> Array:
        """(6, nv): velocity of the point, then angular velocity, world axes"""
    def bias_forces(self, q: Given = None, v: Given = None) -> Array:
        """(nv,) gravity, Coriolis and centripetal forces b of M a + b = τ"""
    def energy(self, q: Given = None, v: Given = None) -> tuple[float, float]:
        """(kinetic, potential) [J]"""
    def momentum(self, q: Given = None, v: Given = None) -> Array:
        """(6,) linear, then angular about the centre of mass, world axes"""
    def center_of_mass(self, q: Given = None) -> Array: ...
    def center_of_mass_jacobian(self, q: Given = None) -> Array: ...
    def link_velocity(
        self, link: str, point: ArrayLike = (0, 0, 0), q: Given = None, v: Given = None
    ) -> Array:
        """(6,) of the point, then angular, world axes"""
    def link_bias_acceleration(
        self, link: str, point: ArrayLike = (0, 0, 0), q: Given = None, v: Given = None
    ) -> Array:
        """(6,) J̇ v: the acceleration is jacobian() @ a more"""
    def integrate(self, q: ArrayLike, v: ArrayLike, seconds: float = 1.0) -> Array:
        """(nq,) where q is after so many seconds at v"""
    def difference(self, q0: ArrayLike, q1: ArrayLike) -> Array:
        """(nv,) with integrate(q0, difference(q0, q1)) = q1"""
    def inverse_dynamics_derivatives(
        self, a: ArrayLike, q: Given = None, v: Given = None
    ) -> tuple[Array, Array, Array]:
        """(∂τ/∂q, ∂τ/∂v, ∂τ/∂a), (nv, nv) each"""
    def forward_dynamics_derivatives(
        self, tau: Given = None, q: Given = None, v: Given = None
    ) -> tuple[Array, Array, Array]:
        """(∂a/∂q, ∂a/∂v, ∂a/∂τ), (nv, nv) each"""
    def step_derivatives(
        self, tau: Given = None, q: Given = None, v: Given = None
    ) -> tuple[Array, Array]:
        """(A, B): ∂(q, v)/∂(q, v) (2 nv, 2 nv) and ∂(q, v)/∂τ (2 nv, nv) of one bare step"""
    @property
    def name(self) -> str: ...
    @property
    def nq(self) -> int: ...
    @property
    def nv(self) -> int: ...
    @property
    def timestep(self) -> float: ...
    @property
    def mass(self) -> float: ...
    @property
    def links(self) -> list[str]: ...
    @property
    def joints(self) -> list[str]: ...
    @property
    def q_names(self) -> list[str]: ...
    @property
    def v_names(self) -> list[str]: ...
    @property
    def actuated(self) -> list[bool]: ...
    @property
    def effort(self) -> Array:
        """(nv, 2) [N m or N]"""
    @property
    def range(self) -> Array:
        """(nv, 2) [rad or m]"""
    @property
    def warnings(self) -> list[str]: ...

class States:
    """Many states of one simulation's scene, for runs that go on. One thread at a time."""

    def __init__(self, sim: Simulation, n: int) -> None: ...
    def reset(self, rows: Given = None, q: Given = None, v: Given = None) -> None:
        """rows: indices or a mask (n,); all where they are not said."""
    @property
    def q(self) -> Array:
        """(n, nq) a copy"""
    @property
    def v(self) -> Array:
        """(n, nv) a copy"""
    @property
    def time(self) -> Array:
        """(n,) [s]"""
    @property
    def nbytes(self) -> int: ...
    def __len__(self) -> int: ...

class Runs:
    """What a rollout gave. What comes after a failed step is NaN."""

    @property
    def q(self) -> Array:
        """(runs, rows, nq)"""
    @property
    def v(self) -> Array:
        """(runs, rows, nv)"""
    @property
    def a(self) -> Array:
        """(runs, rows, nv)"""
    @property
    def tau(self) -> Array:
        """(runs, rows, nv)"""
    @property
    def contact_forces(self) -> Array:
        """(runs, rows, links, 3)"""
    @property
    def status(self) -> list[str]: ...
    @property
    def failure(self) -> list[str]: ...
    @property
    def steps(self) -> NDArray[np.int64]: ...

class Rollout:
    """Runs a simulation's scene many times on all cores."""

    def __init__(self, sim: Simulation, threads: int = 0) -> None: ...
    def run(
        self,
        steps: int,
        *,
        runs: int | None = None,
        q0: Given = None,
        v0: Given = None,
        tau: Given = None,
        parameters: Mapping[str, ArrayLike] | None = None,
        goals: Goals_ | None = None,
        targets: Given = None,
        pushes: Mapping[str, ArrayLike] | None = None,
        states: States | None = None,
        outputs: Sequence[str] = ("q", "v"),
        every: int = 1,
        progress: Callable[[int, int], None] | None = None,
    ) -> Runs: ...
    @property
    def threads(self) -> int: ...
    @property
    def contact_links(self) -> list[str]: ...
    @property
    def bytes_per_run(self) -> int: ...
    @property
    def bytes_per_thread(self) -> int: ...
