# SPDX-License-Identifier: Apache-2.0
"""What times say and how far they hold: times.py FOLDER [OTHER].

FOLDER is that of study.py, whose times.jsonl holds a line a timed run, with the session that it belongs
to. A figure is the CPU time of a step over that of the fixed piece of arithmetic beside it: median and
range over all rounds. Two sessions, or the whole of two folders, agree on a figure where their ranges
meet. Prints the figures on which they do not, and how many of them chance would give; ends with 1 where
there are more.
"""
import csv
import json
import math
import pathlib
import statistics
import sys
from dataclasses import dataclass


@dataclass(frozen=True)
class Figure:
    """Of one scene, column and step: ratios of a step's time to the calibration's, ascending."""
    ratios: tuple
    calibration_us: float  # median [µs]
    load: float            # median load of the machine
    end: str

    @property
    def median(self):
        return statistics.median(self.ratios)

    def meets(self, other):
        return self.ratios[0] <= other.ratios[-1] and other.ratios[0] <= self.ratios[-1]


COLUMNS = {"scene": str, "entry": str, "h": float, "session": int, "round": int, "us_a_step": float, "calibration_us": float, "load": float, "end": str}


def read(folder):
    """Rounds of a study, with the digits that are kept: a page of them and one of what is kept are the same."""
    path = pathlib.Path(folder) / "times.jsonl"
    rows = [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []
    return [{name: digits(v) if COLUMNS.get(name) is float else v for name, v in r.items()} for r in rows]


def digits(v):
    return float(f"{v:.5g}")


def write(path, runs):
    """All rounds as the page's data, docs/rivals/times.csv; five digits of each time."""
    rows = sorted(runs, key=lambda r: (r["scene"], r["entry"], r["h"], r.get("session", 0), r["round"]))
    with pathlib.Path(path).open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for r in rows:
            values = [r.get(name, 0) for name in COLUMNS]
            table.writerow([f"{v:.5g}" if isinstance(v, float) else v for v in values])


def kept(path):
    """What write() has written; nothing where there is no such file."""
    path = pathlib.Path(path)
    if not path.exists():
        return []
    with path.open(newline="") as file:
        return [{name: kind(row[name]) for name, kind in COLUMNS.items()} for row in csv.DictReader(file)]


def merged(new, old):
    """Of each scene that was timed anew the new rounds, so that engines beside each other were; else the old ones."""
    scenes = {r["scene"] for r in new}
    return new + [r for r in old if r["scene"] not in scenes]


def figures(runs):
    """By scene, entry and step."""
    by = {}
    for r in runs:
        by.setdefault((r["scene"], r["entry"], r["h"]), []).append(r)
    return {key: Figure(tuple(sorted(r["us_a_step"] / r["calibration_us"] for r in rs)),
                        statistics.median(r["calibration_us"] for r in rs),
                        statistics.median(r["load"] for r in rs), rs[-1]["end"]) for key, rs in by.items()}


def by_chance(a, b):
    """Probability that the ranges of two samples of the same thing do not meet."""
    m, n = len(a.ratios), len(b.ratios)
    return 2 / math.comb(m + n, n)


def sessions(runs):
    """Runs by session, in order."""
    out = {}
    for r in runs:
        out.setdefault(r.get("session", 0), []).append(r)
    return list(out.values())


def compare(first, second):
    """Lines on what two sets of runs do not agree on, and whether chance allows as much."""
    a, b = figures(first), figures(second)
    common = [key for key in a if key in b]
    apart = [key for key in common if not a[key].meets(b[key])]
    lines = [f"{scene}, {entry}, {1e3 * h:g} ms: {a[scene, entry, h].median:.3g} and {b[scene, entry, h].median:.3g} times the calibration, "
             f"{100 * (b[scene, entry, h].median / a[scene, entry, h].median - 1):+.1f} %" for scene, entry, h in apart]
    chance = sum(by_chance(a[key], b[key]) for key in common)
    # Three standard deviations of a count that is rare.
    allowed = chance + 3 * math.sqrt(chance)
    lines.append(f"{len(apart)} of {len(common)} figures differ by more than their spread; chance would give {chance:.2g}.")
    return lines, len(apart) <= allowed


def main(folder, other=None):
    parts = [read(folder), read(other)] if other else sessions(read(folder))
    if len(parts) < 2 or not all(parts):
        sys.exit("there is nothing to compare: two folders with times, or one with two sessions")
    fine = True
    for first, second in zip(parts, parts[1:]):
        lines, holds = compare(first, second)
        print("\n".join(lines))
        fine = fine and holds
    sys.exit(0 if fine else 1)


if __name__ == "__main__":
    main(*sys.argv[1:])
