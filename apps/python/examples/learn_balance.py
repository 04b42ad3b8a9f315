# SPDX-License-Identifier: Apache-2.0
"""A humanoid learns to keep its balance under pushes.

The same policy is trained twice by the cross-entropy method: once it puts out accelerations, which
goal directed dynamics turns into torques that motors and contacts allow, and once torques. Both
begin at zero: they know nothing.

    python3 learn_balance.py humanoid.urdf --seconds 900 --out balance.svg

A policy sees how the pelvis leans, turns and moves, and every joint. Of each joint it has two
gains; of those that bend forwards and sideways also weights on the pelvis: 56 numbers in all. Left
and right are mirror images.
"""

import argparse
import json
import time

import numpy as np

import softgauss

FORWARD = ["abdomen_pitch", "hip_pitch", "knee", "ankle_pitch", "shoulder_pitch"]
SIDEWAYS = ["abdomen_roll", "hip_roll", "ankle_roll"]
OTHERS = ["abdomen_yaw", "hip_yaw", "shoulder_roll", "elbow"]
GROUPS = FORWARD + SIDEWAYS + OTHERS
SIZE = 2 * len(GROUPS) + 4 * len(FORWARD) + 4 * len(SIDEWAYS)
# What counts as one of each: leaning [rad], turning [rad/s], speed [m/s], offset [m]; of a joint
# its angle [rad] and speed [rad/s]
PELVIS_UNITS = np.array([0.1, 1.0, 0.3, 0.1])
JOINT_UNITS = np.array([0.2, 2.0])


class Policy:
    """Actions, each of size 1 or so, from parameters (n, SIZE) at states of the humanoid."""

    def __init__(self, joints):
        self.group = np.array(
            [GROUPS.index(j.replace("left_", "").replace("right_", "")) for j in joints]
        )
        # What leans to the left bends the left leg outwards and the right one inwards.
        self.side = np.array([-1.0 if j.startswith("right_") else 1.0 for j in joints])

    def __call__(self, parameters, q, v):
        n, groups, forward = len(q), len(GROUPS), len(FORWARD)
        pitch = 2 * (q[:, 3] * q[:, 5] - q[:, 4] * q[:, 6])
        roll = 2 * (q[:, 3] * q[:, 4] + q[:, 5] * q[:, 6])
        ahead = np.stack([pitch, v[:, 4], v[:, 0], q[:, 0]], axis=1) / PELVIS_UNITS
        aside = np.stack([-roll, -v[:, 3], v[:, 1], q[:, 1]], axis=1) / PELVIS_UNITS
        gains = parameters[:, : 2 * groups].reshape(n, groups, 2)[:, self.group]
        weights = parameters[:, 2 * groups :].reshape(n, forward + len(SIDEWAYS), 4)
        pull = np.zeros((n, groups))
        pull[:, :forward] = np.einsum("ngk,nk->ng", weights[:, :forward], ahead)
        pull[:, forward : forward + len(SIDEWAYS)] = np.einsum(
            "ngk,nk->ng", weights[:, forward:], aside
        )
        mirrored = np.isin(self.group, range(forward, forward + len(SIDEWAYS)))
        out = pull[:, self.group] * np.where(mirrored, self.side, 1.0)
        out -= gains[..., 0] * q[:, 7:] / JOINT_UNITS[0]
        return out - gains[..., 1] * v[:, 6:] / JOINT_UNITS[1]


class Balance:
    """Episodes of many humanoids, each pushed once, each with a policy of its own."""

    PUSH_FROM, PUSH_UNTIL = 0.2, 0.4  # [s]

    def __init__(self, model, action, count, seconds, threads=0):
        self.env = softgauss.VectorEnv(
            model,
            count,
            reward=lambda q, v, a: np.zeros(len(q)),
            action=action,
            timestep=0.005,
            frame_skip=4,
            duration=2 * seconds,
            threads=threads,
            terminated=lambda q, v: q[:, 2] < self.least_height,
        )
        sim = self.env.sim
        self.least_height = sim.q[2] - 0.25
        self.policy = Policy(sim.joints)
        high = self.env.single_action_space.high
        self.scale = 0.1 * high if action == "torque" else np.full_like(high, 10.0)
        self.frames = round(seconds / self.env.dt)

    def costs(self, parameters, impulses):
        """Costs (n,) between 0 and 1 and whether each still stands (n,), of policies (n, SIZE)
        under horizontal impulses (n, 2) [N s]. A frame costs 1 once it has fallen; before that a little
        for swaying."""
        env, n = self.env, len(parameters)
        env.reset()
        cost, fallen = np.zeros(n), np.zeros(n, bool)
        for frame in range(self.frames):
            now = frame * env.dt
            pushing = self.PUSH_FROM <= now < self.PUSH_UNTIL
            force = np.zeros((n, 3))
            force[:, :2] = impulses / (self.PUSH_UNTIL - self.PUSH_FROM)
            env.pushes = {"torso": force} if pushing else {}
            q, v = env.states.q, env.states.v
            action = self.scale * self.policy(parameters, q, v)
            _, _, over, _, _ = env.step(action)
            q, v = env.states.q, env.states.v
            fallen |= over  # a step that is refused ends the episode, too
            sway = np.sum(v[:, :2] ** 2, axis=1) + np.sum(q[:, :2] ** 2, axis=1)
            cost += np.where(fallen, 1.0, np.minimum(sway, 0.5))
            if fallen.all():
                cost += self.frames - frame - 1
                break
        return cost / self.frames, ~fallen


def pushes(random, count, strength):
    """Impulses (count, 2) of all directions, of up to `strength` [N s]."""
    angle = random.uniform(0, 2 * np.pi, count)
    size = strength * random.uniform(0.5, 1.0, count)
    return np.stack([size * np.cos(angle), size * np.sin(angle)], axis=1)


def train(
    model,
    action,
    *,
    seconds,
    generations=10**6,
    population=48,
    trials=4,
    tests=32,
    strength=16.0,
    episode=5.0,
    threads=0,
    seed=0,
    tell=print,
):
    """The cross-entropy method: draws policies about a mean, keeps the best sixth, moves the mean
    and the spread there. Returns the mean and a list of what each generation showed."""
    random = np.random.default_rng(seed)
    exam = pushes(
        np.random.default_rng(10**6), tests, strength
    )  # the same for all, never trained
    many = Balance(model, action, population * trials, episode, threads)
    few = Balance(model, action, tests, episode, threads)
    mean, spread = np.zeros(SIZE), np.ones(SIZE)
    curve, began, worked, episodes = [], time.monotonic(), time.process_time(), 0
    for generation in range(generations + 1):
        cost, stands = few.costs(np.tile(mean, (tests, 1)), exam)
        curve.append(
            {
                "episodes": episodes,
                "seconds": time.monotonic() - began,
                "cpu_seconds": time.process_time() - worked,
                "cost": cost.mean(),
                "standing": stands.mean(),
            }
        )
        tell(
            f"{action:12} {episodes:6} episodes {curve[-1]['seconds']:5.0f} s "
            f"({curve[-1]['cpu_seconds']:.0f} s of CPU): cost {cost.mean():.3f}, "
            f"{stands.sum()} of {tests} pushes survived"
        )
        if curve[-1]["seconds"] > seconds or generation == generations:
            return mean, curve
        drawn = mean + spread * random.normal(size=(population, SIZE))
        drawn[0] = mean
        trial = pushes(random, trials, strength)
        cost, _ = many.costs(np.repeat(drawn, trials, axis=0), np.tile(trial, (population, 1)))
        cost = cost.reshape(population, trials).mean(axis=1)
        best = drawn[np.argsort(cost, kind="stable")[: population // 6]]
        mean = 0.3 * mean + 0.7 * best.mean(axis=0)
        spread = 0.3 * spread + 0.7 * (best.std(axis=0) + 0.02)
        episodes += population * trials


def picture(file, curves):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7, 4))
    for action, curve in curves.items():
        axes.plot(
            [c["episodes"] for c in curve], [100 * c["standing"] for c in curve], label=action
        )
    axes.set_xlabel("episodes")
    axes.set_ylabel("pushes survived [%]")
    axes.legend()
    figure.savefig(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model")
    parser.add_argument("--actions", nargs="+", default=["acceleration", "torque"])
    parser.add_argument("--seconds", type=float, default=900, help="of training, for each")
    parser.add_argument("--generations", type=int, default=10**6, help="at most")
    parser.add_argument("--population", type=int, default=48)
    parser.add_argument("--strength", type=float, default=16.0, help="of pushes, at most [N s]")
    parser.add_argument("--episode", type=float, default=5.0, help="how long one lasts [s]")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--out", help="a picture of what was learnt when")
    parser.add_argument("--json", help="the policies and the curves")
    args = parser.parse_args()

    curves, policies = {}, {}
    for action in args.actions:
        mean, curves[action] = train(
            args.model,
            action,
            seconds=args.seconds,
            generations=args.generations,
            population=args.population,
            strength=args.strength,
            episode=args.episode,
            seed=args.seed,
            threads=args.threads,
        )
        policies[action] = mean.tolist()
    if args.out:
        picture(args.out, curves)
    if args.json:
        with open(args.json, "w") as out:
            json.dump({"policies": policies, "curves": curves}, out, indent=1)


if __name__ == "__main__":
    main()
