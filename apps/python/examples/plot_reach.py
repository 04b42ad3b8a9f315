# SPDX-License-Identifier: Apache-2.0
"""An arm reaches a place: the hand's distance from it, and the torques that brought it there.

    python3 plot_reach.py arm.urdf --out reach.svg
"""

import argparse

import matplotlib.pyplot as plt
import numpy as np

import softgauss


def reach(model, link, place, seconds):
    """Times (n,), distances of the link from the place (n,) and torques (n, joints)."""
    sim = softgauss.Simulation(model)
    sim.goals.reach(link, place)
    times, distances, torques = [], [], []
    while sim.time < seconds:
        sim.step()
        times.append(sim.time)
        distances.append(np.linalg.norm(sim.pose(link)[:3, 3] - place))
        torques.append([sim.torque(joint) for joint in sim.joints])
    return sim.joints, np.array(times), np.array(distances), np.array(torques)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model")
    parser.add_argument("--link", default="hand")
    parser.add_argument("--place", type=float, nargs=3, default=[0.5, 0.3, 0.5], help="[m]")
    parser.add_argument("--seconds", type=float, default=1.5)
    parser.add_argument("--out", default="reach.svg")
    args = parser.parse_args()

    joints, times, distances, torques = reach(args.model, args.link, args.place, args.seconds)
    figure, (top, bottom) = plt.subplots(2, sharex=True, figsize=(7, 6))
    top.plot(times, 1e3 * distances)
    top.set_ylabel(f"distance of {args.link} [mm]")
    bottom.plot(times, torques, label=joints)
    bottom.set_xlabel("time [s]")
    bottom.set_ylabel("torque [N m]")
    bottom.legend(fontsize="small")
    figure.savefig(args.out)
    print(f"{args.link} ends {1e3 * distances[-1]:.1f} mm from the place; picture: {args.out}")


if __name__ == "__main__":
    main()
