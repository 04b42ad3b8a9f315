# SPDX-License-Identifier: Apache-2.0
"""The gate: a run counts only where the engine was given the scene, and not something like it.

A run is refused where mass, start or kinetic energy are not the scene's, or where the scene itself
begins with an overlap. Of smooth scenes all of an engine's runs are refused where its inertia is not
that of the others, or where its digits differ from those of others with the same method.
"""
import math
import statistics

import plan

# Of numbers that should be the same to rounding; engines in single precision have 24 bits.
EXACT, SINGLE = 1e-6, 2e-5
SAME_DIGITS = 0.01  # two digits of an error: beyond, the method is not the same, or the model
SAME_INERTIA = 1e-9
SECOND_WAY = 1e-5  # [m] of a scene written a second time: single precision, over 450 steps
REFERENCES_AGREE = 1e-10  # [m]
# What the gate refuses outright is no result; a run that diverges or comes late is one.
RAN = ("done", "diverged", "late")


def relative(a, b):
    return abs(a - b) / max(abs(a), abs(b), 1e-9)


def refusal_of_run(run):
    """Why a run does not count, or None."""
    if run["end"] not in RAN:
        return None if run["end"] in ("cannot express", "crashed") else "no judgement"
    judged = run.get("judged", {})
    if "gate" not in judged:
        return None if run["end"] == "late" else f"not judged: {judged.get('why', 'no states')}"
    gate = judged["gate"]
    bound = SINGLE if run["entry"].split()[0] in plan.SINGLE_PRECISION else EXACT
    if gate["overlap_at_start"] > bound:
        return f"the scene begins with an overlap of {gate['overlap_at_start']:.2g} m"
    if not gate["start_error"] <= bound * scale(run["scene"]):
        return f"start differs by {gate['start_error']:.2g}"
    if not relative(run["mass"], gate["mass"]) <= bound:
        return f"mass {run['mass']:.7g} kg for {gate['mass']:.7g} kg"
    if "kinetic_energy" in run and not relative(run["kinetic_energy"], gate["kinetic_energy"]) <= 10 * bound:
        return f"kinetic energy {run['kinetic_energy']:.7g} J for {gate['kinetic_energy']:.7g} J"
    second = judged.get("measures", {}).get("second_m", 0.0)
    if second > SECOND_WAY:
        return f"{second:.2g} m from the same scene, written a second time"
    return None


def scale(scene):
    """Of speeds at the start [rad/s or m/s]: rounding is relative to them."""
    return 100.0 if scene in ("top", "free_body") else 1.0


def same_inertia(runs):
    """Engines whose joint-space inertia of a chain is not that of most others, and by how much."""
    with_one = {r["entry"]: r["mass_matrix"] for r in runs if r["scene"] == "chain_20" and r.get("mass_matrix")}
    if len(with_one) < 2:
        return {}
    median = [statistics.median_low(x) for x in zip(*with_one.values())]
    size = max(abs(x) for x in median)
    off = {entry: max(abs(a - b) for a, b in zip(M, median)) / size for entry, M in with_one.items()}
    return {entry.split()[0]: error for entry, error in off.items() if error > SAME_INERTIA}


def error_of(run):
    return run.get("judged", {}).get("measures", {}).get("error_m")


def other_digits(runs):
    """(scene, entry) whose error is not that of the others with its method at 2 ms, and both."""
    labels = {e.label: e.key for e in plan.ENTRIES}
    refused = {}
    for scene in plan.SMOOTH:
        for group in plan.SAME_DIGITS:
            keys = [labels[label] for label in group]
            errors = {r["entry"]: error_of(r) for r in runs if r["scene"] == scene and r["h"] == plan.STEP
                      and r["entry"] in keys and error_of(r) is not None}
            # A floating base is a matter of its own: MuJoCo's and Bullet's RK4 move quaternions otherwise.
            if len(errors) < 3 or scene != "chain_20":
                continue
            median = statistics.median(errors.values())
            for entry, error in errors.items():
                if not math.isclose(error, median, rel_tol=SAME_DIGITS):
                    refused[scene, entry] = f"error {error:.4g} m for {median:.4g} m of the same method elsewhere"
    return refused


def references(runs):
    """Distance of the two references, by scene [m]."""
    first, second = (e.key for e in plan.REFERENCES)
    return {r["scene"]: error_of(r) for r in runs if r["entry"] == second and r.get("reference") == first
            and error_of(r) is not None}


def refusals(runs):
    """(scene, entry, h) and why, of all that the gate lets not pass."""
    inertia, digits, agree = same_inertia(runs), other_digits(runs), references(runs)
    out = {}
    for r in runs:
        key = r["scene"], r["entry"], r["h"]
        if "refused" in r:  # decided when it ran
            if r["refused"]:
                out[key] = r["refused"]
            continue
        why = refusal_of_run(r) or digits.get(key[:2])
        if not why and r["scene"] in plan.SMOOTH and r["entry"].split()[0] in inertia:
            why = f"inertia of the chain off by {inertia[r['entry'].split()[0]]:.2g}"
        if not why and r["scene"] in plan.SMOOTH and agree.get(r["scene"], 0.0) > REFERENCES_AGREE:
            why = f"the two references differ by {agree[r['scene']]:.2g} m"
        if why:
            out[key] = why
    return out
