# SPDX-License-Identifier: Apache-2.0
"""What Python adds to a step and to a rollout.

    python3 measure_cost.py humanoid.urdf arm.urdf

step(n) takes n steps in C++ in one call; a loop over step() calls C++ n times: the difference is
Python's. A rollout of n steps less one of a single step is measured beside step(n). They are taken
in turn, many times over, and the least time of each is told: whatever disturbs only adds to it.
"""

import argparse
import time

import numpy as np

import softgauss


def timed(work):
    begin = time.perf_counter()
    work()
    return 1e6 * (time.perf_counter() - begin)


def loop(sim, n):
    for _ in range(n):
        sim.step()


def measure(model, steps, rounds):
    """Least times [µs] of a step in C++, from Python and of a rollout; and of a rollout's begin."""
    sim = softgauss.Simulation(model)
    rollout = softgauss.Rollout(sim, 1)

    def roll(n):
        rollout.run(n, runs=1, outputs=("q",), every=n)

    ways = (
        lambda: sim.step(steps),
        lambda: loop(sim, steps),
        lambda: roll(steps),
        lambda: roll(1),
    )
    times = []
    for _ in range(rounds):
        row = []
        for work in ways:
            sim.reset()
            row.append(timed(work))
        times.append(row)
    native, python, rolled, once = np.min(times, axis=0)
    return native / steps, python / steps, (rolled - once) / (steps - 1), once


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="+")
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--rounds", type=int, default=41)
    args = parser.parse_args()
    for model in args.models:
        native, python, rollout, begin = measure(model, args.steps, args.rounds)
        print(
            f"{model}: a step takes {native:.2f} µs in C++; from Python {python - native:+.2f} µs, "
            f"in a rollout {rollout - native:+.2f} µs, and {begin:.0f} µs once a call"
        )


if __name__ == "__main__":
    main()
