# SPDX-License-Identifier: Apache-2.0
"""What Python adds to a step and to a rollout.

    python3 measure_cost.py humanoid.urdf arm.urdf

step(n) takes n steps in C++ in one call; a loop over step() calls C++ n times: the difference is
Python's. A rollout is measured beside step(n) of the same steps. They are taken in turn, many times
over, in CPU time; medians are told, with the quartiles of what differs.
"""

import argparse
import time

import numpy as np

import softgauss


def timed(work):
    begin = time.process_time()
    work()
    return time.process_time() - begin


def loop(sim, n):
    for _ in range(n):
        sim.step()


def measure(model, steps, rounds):
    """Times of a step [µs] (rounds,): in C++, from Python, of a rollout; and of a rollout's begin."""
    sim = softgauss.Simulation(model)
    rollout = softgauss.Rollout(sim, 1)

    def roll(n):
        rollout.run(n, runs=1, outputs=("q",), every=n)

    times = []
    for _ in range(rounds):
        row = []
        for work in (
            lambda: sim.step(steps),
            lambda: loop(sim, steps),
            lambda: roll(steps),
            lambda: roll(2 * steps),
            lambda: sim.step(2 * steps),
        ):
            sim.reset()
            row.append(1e6 * timed(work))
        native, python, once, twice, native_twice = row
        # What a rollout takes once, to begin, is not of its steps.
        times.append([native, python, native + (twice - once) - (native_twice - native), once])
    native, python, rolled, once = np.array(times).T
    return native / steps, python / steps, rolled / steps, once - native


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="+")
    parser.add_argument("--steps", type=int, default=500)
    parser.add_argument("--rounds", type=int, default=41)
    args = parser.parse_args()
    for model in args.models:
        native, python, rollout, begin = measure(model, args.steps, args.rounds)
        low, middle, high = np.percentile(python - native, [25, 50, 75])
        print(
            f"{model}: a step takes {np.median(native):.2f} µs in C++; from Python "
            f"{middle:+.2f} µs ({low:+.2f} to {high:+.2f})"
        )
        low, middle, high = np.percentile(rollout - native, [25, 50, 75])
        print(
            f"{model}: a step of a rollout {middle:+.2f} µs ({low:+.2f} to {high:+.2f}), "
            f"and {np.median(begin):.0f} µs once a call"
        )


if __name__ == "__main__":
    main()
