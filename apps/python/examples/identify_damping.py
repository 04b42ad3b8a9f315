# SPDX-License-Identifier: Apache-2.0
"""Which damping has a joint of which a log tells positions and torques?

The log is a CSV as simulate_gdd writes it: time_s, q:<joint>, v:<joint>, u:<joint>, rows an equal time
apart. Its torques, each until the next row, are played to many arms at once, each with another damping;
the one that moves as the log did is it. The log is of every step: of one with fewer rows the torques in
between are unknown, and no arm follows it. Without a log one is made, by an arm of known damping and a
sensor with noise.

    python3 identify_damping.py arm.urdf elbow_pitch --log run.csv
    python3 identify_damping.py arm.urdf elbow_pitch --truth 1.7 --noise 1e-3
"""

import argparse
import csv
import pathlib
import sys

import numpy as np

import softgauss

LARGEST_ERROR = 0.01  # of the motion; beyond it another arm, or another force, has moved


def make_log(file, sim, joint, damping, noise, seconds=1.0, seed=0):
    """Torques that swing all joints, and what an arm of this damping does under them."""
    random = np.random.default_rng(seed)
    steps = round(seconds / sim.timestep)
    t = np.arange(steps) * sim.timestep
    rates, phases = random.uniform(1, 3, sim.nv), random.uniform(0, 6, sim.nv)
    tau = 0.05 * sim.effort[:, 1] * np.sin(2 * np.pi * rates * t[:, None] + phases)
    tau += sim.inverse_dynamics(np.zeros(sim.nv))  # carries the arm's weight
    runs = softgauss.Rollout(sim, 1).run(
        steps, tau=tau[None], parameters={f"damping:{joint}": damping}
    )
    q = np.vstack([sim.q, runs.q[0, :-1]])  # a row holds the state at its time
    v = np.vstack([sim.v, runs.v[0, :-1]])
    q[1:] += random.normal(scale=noise, size=q[1:].shape)
    with open(file, "w", newline="") as out:
        write = csv.writer(out)
        write.writerow(["time_s"] + [f"{k}:{name}" for k in "qvu" for name in sim.joints])
        write.writerows(np.hstack([t[:, None], q, v, tau]).tolist())


def read_log(file, sim):
    """The time between rows [s], q (n, nq), v (n, nv) and torques (n − 1, nv) of the steps between
    the rows. Raises ValueError where the log does not tell them."""
    with open(file, newline="") as text:
        rows = list(csv.DictReader(text))
    if len(rows) < 3:
        raise ValueError(f"{file}: found {len(rows)} rows, expected 3 or more")

    def columns(names, rows):
        missing = [name for name in names if name not in rows[0]]
        if missing:
            raise ValueError(f"{file}: found no column '{missing[0]}'; is it of this robot?")
        for line, row in enumerate(rows, start=2):
            for name in names:
                if not is_number(row[name]):
                    raise ValueError(
                        f"{file}:{line}: column '{name}': found '{row[name]}', expected a number"
                    )
        return np.array([[float(row[name]) for name in names] for row in rows])

    return (
        step_of(file, columns(["time_s"], rows)[:, 0]),
        columns(["q:" + name for name in sim.q_names], rows),
        columns(["v:" + name for name in sim.v_names], rows),
        columns(["u:" + name for name in sim.joints], rows[:-1]),
    )


def is_number(text):
    try:
        return bool(np.isfinite(float(text)))
    except (TypeError, ValueError):
        return False


def step_of(file, times):
    """The step of times that are an equal time apart [s]."""
    step = (times[-1] - times[0]) / (len(times) - 1)
    gaps = np.diff(times)
    worst = int(np.argmax(np.abs(gaps - step)))
    if not (step > 0 and abs(gaps[worst] - step) <= 1e-3 * step):
        raise ValueError(
            f"{file}:{worst + 3}: column 'time_s': found a row {gaps[worst]:g} s after the one before, "
            f"expected all rows {step:.6g} s apart"
        )
    return step


def identify(sim, joint, q, v, tau, low=1e-3, high=100.0, rounds=6, points=24):
    """The damping between `low` and `high` whose motion is nearest to q: a search on a grid that
    closes in on the best of it. Returns it and the root mean square of what differs. Raises
    ValueError where the arm moves as in q with none of them."""
    rollout = softgauss.Rollout(sim)
    steps, ends = len(tau), (low, high)
    for _ in range(rounds):
        dampings = np.geomspace(low, high, points)
        runs = rollout.run(
            steps,
            runs=points,
            parameters={f"damping:{joint}": dampings},
            q0=np.tile(q[0], (points, 1)),
            v0=np.tile(v[0], (points, 1)),
            tau=np.broadcast_to(tau, (points,) + tau.shape),
            outputs=("q",),
        )
        error = np.sqrt(np.mean((runs.q - q[1:]) ** 2, axis=(1, 2)))
        if np.isnan(error).all():
            raise ValueError(f"no damping fits: {runs.failure[0]}")
        best = int(np.nanargmin(error))
        low, high = dampings[max(best - 1, 0)], dampings[min(best + 1, points - 1)]
    motion = np.sqrt(np.mean((q - q.mean(axis=0)) ** 2))
    if error[best] > LARGEST_ERROR * motion or np.isclose(dampings[best], ends, rtol=1e-3).any():
        raise ValueError(
            f"no damping from {ends[0]:g} to {ends[1]:g} fits: with the best, {dampings[best]:.4g}, the "
            f"arm is {error[best]:.2g} rad off a motion of {motion:.2g} rad; is the log of this robot, of "
            "every step, and free of contacts and forces from outside?"
        )
    return dampings[best], error[best]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model")
    parser.add_argument("joint")
    parser.add_argument("--log", type=pathlib.Path, help="of a run that was measured")
    parser.add_argument("--truth", type=float, default=1.7, help="damping of the log that is made")
    parser.add_argument("--noise", type=float, default=1e-3, help="of its sensors [rad]")
    args = parser.parse_args()

    sim = softgauss.Simulation(args.model)
    log = args.log or pathlib.Path("measured.csv")
    if not args.log:
        make_log(log, sim, args.joint, args.truth, args.noise)
    try:
        step, *motion = read_log(log, sim)
        sim = softgauss.Simulation(args.model, timestep=step)
        damping, error = identify(sim, args.joint, *motion)
    except (ValueError, LookupError) as error:
        sys.exit(str(error))
    print(
        f"damping of {args.joint}: {damping:.4g} N m s/rad, {error:.2g} rad off the log"
        + ("" if args.log else f"; it was made with {args.truth:g}")
    )


if __name__ == "__main__":
    main()
