# SPDX-License-Identifier: Apache-2.0
"""How slippery and how heavy may a ball be that a hand holds? A sweep on all cores, and a picture.

The hand closes on the ball once. From there it goes on many times, with other friction and another
mass of the ball each time. It has the ball at the end where the ball has not fallen. The fingers lie
below the ball, so that it is its weight that opens them; friction helps a little.

    python3 sweep_grasp.py hand_and_ball.yaml --out grasp.svg
"""

import argparse

import matplotlib.pyplot as plt
import numpy as np

import softgauss

FRICTIONS, MASSES = (0.02, 1.0), (2.0, 20.0)  # between these the hand begins to lose the ball [kg]


def sweep(scene, frictions, masses, seconds, progress=None):
    """Whether the ball is held (frictions, masses), and how far it fell [m]."""
    sim = softgauss.Simulation(scene)
    sim.run(1.0)  # the hand closes; from 0.6 s on it alone carries the ball
    height = sim.q_names.index("ball.z")
    at_first = sim.q[height]

    friction, mass = np.meshgrid(frictions, masses, indexing="ij")
    states = softgauss.States(sim, friction.size)
    runs = softgauss.Rollout(sim).run(
        round(seconds / sim.timestep),
        states=states,
        outputs=(),
        progress=progress,
        parameters={"friction:*": friction.ravel(), "mass:ball": mass.ravel()},
    )
    for run, failure in enumerate(runs.failure):
        if failure:
            print(f"friction {friction.flat[run]:g}, mass {mass.flat[run]:g}: {failure}")
    fallen = (at_first - states.q[:, height]).reshape(friction.shape)
    return fallen < 0.05, fallen


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("--points", type=int, default=16, help="along each axis")
    parser.add_argument("--seconds", type=float, default=1.0)
    parser.add_argument("--out", default="grasp.svg")
    args = parser.parse_args()

    frictions = np.geomspace(*FRICTIONS, args.points)
    masses = np.geomspace(*MASSES, args.points)
    held, _ = sweep(args.scene, frictions, masses, args.seconds)
    figure, axes = plt.subplots(figsize=(6, 5))
    axes.pcolormesh(frictions, masses, held.T, shading="nearest", cmap="RdYlGn", vmin=0, vmax=1)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks(frictions[::5], [f"{x:.2g}" for x in frictions[::5]])
    axes.set_yticks(masses[::5], [f"{x:.2g}" for x in masses[::5]])
    axes.minorticks_off()
    axes.set_xlabel("friction of everything")
    axes.set_ylabel("mass of the ball [kg]")
    axes.set_title("green: the hand holds the ball; red: it falls")
    figure.savefig(args.out)
    print(f"{held.sum()} of {held.size} balls are held; picture: {args.out}")


if __name__ == "__main__":
    main()
