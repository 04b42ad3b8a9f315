# SPDX-License-Identifier: Apache-2.0
"""What the study runs: engines with their defaults and their documented best, scenes and steps."""
from dataclasses import dataclass, field

import scenes


@dataclass(frozen=True)
class Entry:
    """A column: an engine with settings."""
    engine: str
    label: str
    settings: tuple = ()
    role: str = "default"  # or best, option, published, gate
    source: str = ""       # of the advice
    scenes: tuple = field(default=(), compare=False)  # kinds that it takes part in; none: all

    @property
    def key(self):
        return " ".join((self.engine, *self.settings))


# Scenes by the kind of table that they belong to. The kinds are never mixed.
SMOOTH = ("chain_20", "humanoid_in_the_air")
DRIFT = ("chain_10_long", "top", "free_body", "thrown_body", "published_body")
THROWN = tuple(f"thrown_{s:g}_{a:g}" for s in scenes.SPEEDS for a in scenes.DIRECTIONS)
FRICTION = THROWN + ("slides_37", "creep_15", "creep_50", "creep_99", "creep_99_askew", "rolling")
BOUNCE = tuple(f"bounce_{kind}_{100 * e:g}" for kind in ("ball", "box") for e in scenes.machines.RESTITUTIONS)
MACHINES = ("nut_rests", "nut_runs", "feet")
HOLD = ("mass_1000", "tower_10", "tower_20", "grip", "grip_shaken", "cart", "peg", "rope", "humanoid_falls", "pile_50", "capsules_27") + MACHINES
SOFTNESS = ("drop",)
PUBLISHED_CONTACTS = ("published_bounce", "published_rolling")
KINDS = {"smooth": SMOOTH, "drift": DRIFT, "friction": FRICTION, "bounce": BOUNCE, "hold": HOLD, "softness": SOFTNESS,
         "published": PUBLISHED_CONTACTS}
# Of truth: what errors are drawn of, over the step and over time. The measure, its axis, and what it is.
WORK = {"chain_20": ("error_m", "error [m]", "a chain of 20 links: root mean square, from Simbody at 1e-12"),
        "humanoid_in_the_air": ("error_m", "error [m]", "a humanoid in the air: root mean square, from Simbody at 1e-12"),
        "top": ("tilt_error_deg", "error [°]", "a top at 100 rad/s, 10 s: its tilt, from the closed form"),
        "thrown_2_37": ("off_mm", "error [mm]", "a box thrown at 2 m/s and 37°: its way, from Coulomb's law")}
TIMED = HOLD + tuple(WORK)

# Scenes that are timed alone, of several sizes.
SIZED = tuple(scene for name, sizes in scenes.SIZES.items() for n in sizes if (scene := f"{name}_{n}") not in TIMED)

CONTACT = ("friction", "bounce", "hold", "softness", "published")
MOTION = ("smooth", "drift")

ENTRIES = (
    Entry("ours", "ours"),
    Entry("ours", "ours, elliptic", ("cone=elliptic",), "best", "docs/guide/contact.md", CONTACT),
    Entry("ours", "ours, RK4", ("integrator=runge-kutta-4",), "best", "docs/guide/integrators.md", MOTION),
    Entry("ours", "ours, Dormand-Prince 1e-5", ("integrator=dormand-prince", "integration_tolerance=1e-5"), "best",
          "docs/guide/integrators.md", MOTION),
    Entry("ours", "ours, Euler", ("integrator=semi-implicit-euler",), "gate", "", ("smooth",)),
    Entry("mujoco", "MuJoCo"),
    Entry("mujoco", "MuJoCo, elliptic, noslip", ("cone=elliptic", "impratio=10", "noslip=10"), "best",
          "MuJoCo documentation, Modeling, Preventing slip", CONTACT),
    Entry("mujoco", "MuJoCo, RK4", ("integrator=RK4",), "best", "MuJoCo documentation, Computation, Numerical integration",
          MOTION),
    Entry("dart", "DART"),
    Entry("dart", "DART, PGS", ("solver=pgs",), "best", "DART's authors, dartsim/dart#1068", CONTACT),
    Entry("bullet", "Bullet", ("preset=pybullet",), "best", "PyBullet's server, which sets it so"),
    Entry("bullet", "Bullet, library", (), "default", "", CONTACT),
    Entry("bullet", "Bullet, RK4", ("integrator=rk4",), "best", "btMultiBody::useRK4Integration", ("smooth", "drift")),
    Entry("bullet", "Bullet, as SimBenchmark", ("erp2=0", "free=multibody"), "published", "leggedrobotics/SimBenchmark", ("published",)),
    Entry("ode", "ODE"),
    Entry("ode", "ODE, quick", ("step=quick",), "option", "Gazebo Classic's settings"),
    Entry("simbody", "Simbody"),
    Entry("simbody", "Simbody, 1e-5", ("accuracy=1e-5", "transition_velocity=0.001"), "best",
          "Simbody's Integrator and CompliantContactSubsystem reference"),
    Entry("mujoco_npm", "MuJoCo (npm)"),
    Entry("mujoco_npm", "MuJoCo (npm), elliptic, noslip", ("cone=elliptic", "impratio=10", "noslip=10"), "best",
          "MuJoCo documentation, Modeling, Preventing slip", CONTACT),
    Entry("rapier_npm", "Rapier"),
    Entry("rapier_npm", "Rapier, 8 iterations", ("iterations=8",), "best", "Rapier's reference, IntegrationParameters"),
    Entry("jolt_npm", "Jolt"),
    Entry("jolt_npm", "Jolt, 50 iterations", ("velocity_steps=50", "position_steps=10"), "best",
          "Jolt's author, jrouwe/JoltPhysics#1390; the numbers are ours"),
)

# Two codes without a common line, as exact as they come: what smooth scenes are judged by.
REFERENCES = (Entry("simbody", "Simbody, 1e-12", ("accuracy=1e-12",), "reference"),
              Entry("ours", "ours, Dormand-Prince 1e-13", ("integrator=dormand-prince", "integration_tolerance=1e-13"),
                    "reference"))
REFERENCE_STEP = 0.01

# The same method in several engines gives the same digits, or a model is not the same.
SAME_DIGITS = (("ours, Euler", "MuJoCo", "DART", "Bullet"), ("ours, RK4", "MuJoCo, RK4", "Bullet, RK4"))

# Engines that share no digits with another one: their row has a second way, second/, in this scene.
SECOND, SECOND_SCENE = ("ode", "rapier_npm", "jolt_npm"), "thrown_2_37"

MOST, MOST_QUICK = 60.0, 4.0  # of CPU time a run [s]
STEP = 0.002
# What others have published of their own scenes at 1 ms, by columns: measures, and figures of each engine. Of the box: Gazebo 6
# in 2015, scpeters/benchmark. Of bounces and what rolls: leggedrobotics/SimBenchmark in 2018, data/bouncing/sample.csv (49 balls
# that do not touch one another, 49² times the square of one's error) and data/rolling/default.csv (pushed askew, Euler, no ERP).
PUBLISHED_STEP = 0.001
ALIKE = 49 ** 2
PUBLISHED = {
    "published_body": (("parabola_mm", "momentum"), {
        "ODE": (49, 0.0130708), "Bullet": (49, 0.0124501), "Simbody": (24.5, 0.00643471), "DART": (49, 2.1861)}),
    "published_bounce": (("energy_error_J2",), {
        "ODE": (185.027 / ALIKE,), "ODE, quick": (185.027 / ALIKE,), "Bullet, as SimBenchmark": (75245.4 / ALIKE,), "DART": (72274.4 / ALIKE,),
        "DART, PGS": (72274.4 / ALIKE,)}),
    "published_rolling": (("velocity_error_m2_s2",), {
        "ODE, quick": (3.14497,), "Bullet, as SimBenchmark": (5.70654e-09,), "DART": (3.14497,), "DART, PGS": (3.14497,), "MuJoCo, elliptic, noslip": (0.00692691,)})}
STEPS = (0.01, 0.005, 0.002, 0.001, 0.0005)
SINGLE_PRECISION = ("rapier_npm", "jolt_npm")


def kind_of(scene):
    if scene in SIZED:
        return "smooth" if scene.startswith("chain") else "hold"
    return next(kind for kind, names in KINDS.items() if scene in names)


def takes_part(entry, scene):
    return not entry.scenes or kind_of(scene) in entry.scenes


def timed_steps(entry, scene):
    """Steps at which a scene is timed: where errors are drawn, all."""
    if entry.engine == "simbody":
        return (STEP, REFERENCE_STEP) if scene in SMOOTH else (STEP,)
    return STEPS if scene in WORK else (STEP,)


def runs(quick=False):
    """(scene, entry, step) of all runs, the references first."""
    for scene in SMOOTH:
        for entry in REFERENCES:
            yield scene, entry, REFERENCE_STEP
    for kind, names in KINDS.items():
        for scene in names:
            if quick and scene in THROWN and not scene.startswith("thrown_2_"):
                continue
            if quick and scene in ("tower_20", "pile_50", "capsules_27"):
                continue
            for entry in ENTRIES:
                if not takes_part(entry, scene):
                    continue
                steps = (STEP,)
                if scene in WORK and not quick and entry.engine != "simbody":
                    steps = STEPS
                if scene == "tower_10" and not quick:
                    steps = (STEP, 0.01)
                if scene in PUBLISHED:
                    steps = (PUBLISHED_STEP,)
                if scene == "nut_runs" and not quick:
                    steps = (STEP, 0.0005)
                for h in steps:
                    yield scene, entry, 0.01 if entry.engine == "simbody" and kind == "smooth" else h
