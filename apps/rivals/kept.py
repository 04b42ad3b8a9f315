# SPDX-License-Identifier: Apache-2.0
"""Results as they are kept in docs/rivals/results.csv, written and read again."""
import csv

import plan

HEAD = ("scene", "engine", "settings", "h", "version", "end", "time", "why", "refused", "measures")


def write(path, runs, refusals):
    with path.open("w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(HEAD)
        for (scene, entry, h), r in sorted(runs.items()):
            engine, *settings = entry.split()
            m = r.get("judged", {}).get("measures", {})
            out.writerow([scene, engine, " ".join(settings), h, r.get("version", ""), r["end"],
                          f"{r['time']:.6g}" if r["end"] == "diverged" else "", r.get("why", ""), refusals.get((scene, entry, h), ""),
                          " ".join(f"{k}={v:.6g}" for k, v in sorted(m.items()) if v is not None)])


def read(path, fresh):
    """Runs that `fresh` ones leave as they are: of the plan, and of the version that has run, where one has."""
    versions = {}
    for r in fresh.values():
        if "version" in r:
            versions.setdefault(r["entry"].split()[0], set()).add(r["version"])
    planned = {(scene, entry.key, h) for scene, entry, h in plan.runs()}
    out = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            entry = " ".join((row["engine"], *row["settings"].split()))
            key = row["scene"], entry, float(row["h"])
            other = row["version"] and row["engine"] in versions and row["version"] not in versions[row["engine"]]
            if key not in planned or key in fresh or other:
                continue
            measures = {k: float(v) for k, v in (pair.split("=") for pair in row["measures"].split())}
            run = {"scene": row["scene"], "entry": entry, "h": key[2], "end": row["end"], "why": row["why"],
                   "refused": row["refused"], "judged": {"measures": measures}}
            if row["version"]:
                run["version"] = row["version"]
            if row["time"]:
                run["time"] = float(row["time"])
            if entry == plan.REFERENCES[1].key and "error_m" in measures:
                run["reference"] = plan.REFERENCES[0].key
            out[key] = run
    return out
