# SPDX-License-Identifier: Apache-2.0
"""What a case asks of every engine alike, and how a run did: held, missed, diverged, late, cannot."""
import math

import plan


def within(**bounds):
    """Measures whose size is at most that."""
    return lambda m: all(abs(m.get(name, math.inf)) <= bound for name, bound in bounds.items())


# Name of the case, its scenes, and what is asked of each of them. Bounds are those of a user who looks
# at the result, not of what any engine reaches: 1 % of a way, a tenth of a millimetre a second of what should rest.
CASES = (
    ("chain of 20, error 1 mm", ("chain_20",), within(error_m=1e-3)),
    ("humanoid in the air, error 1 mm", ("humanoid_in_the_air",), within(error_m=1e-3)),
    ("chain of 10, energy 1 %", ("chain_10_long",), within(energy_percent=1)),
    ("top, tilt 0.5°", ("top",), within(tilt_error_deg=0.5)),
    ("free body, energy and momentum 1 %", ("free_body", "thrown_body"), within(energy_percent=1, momentum=0.01)),
    ("thrown box, 1 % of its way", tuple(s for s in plan.THROWN if s.startswith("thrown_2_")),
     lambda m: abs(m["off_percent"]) <= 1 and m["aside_mm"] <= 0.01 * m["truth_mm"] and m["turned_deg"] <= 1),
    ("slides down 37°, 1 %", ("slides_37",), lambda m: math.hypot(m["off_mm"], m["aside_mm"]) <= 0.01 * m["truth_mm"]),
    ("stays on a slope of half the cone, 0.1 mm/s", ("creep_50",), within(creep_mm_s=0.1, aside_mm_s=0.1)),
    ("stays at 99 % of the cone, 0.1 mm/s", ("creep_99",), within(creep_mm_s=0.1, aside_mm_s=0.1)),
    ("the same askew, 0.1 mm/s", ("creep_99_askew",), within(creep_mm_s=0.1, aside_mm_s=0.1)),
    ("ball slides, then rolls, 1 %", ("rolling",), lambda m: abs(m["off_mm"]) <= 0.01 * m["truth_mm"] and m["slip_percent"] <= 1),
    ("ball bounces by 0.8 and 0.5, 1 % of its fall", tuple(s for s in plan.BOUNCE if "ball" in s), within(off_percent=1)),
    ("box bounces flat, 1 % of its fall", tuple(s for s in plan.BOUNCE if "box" in s), within(off_percent=1, turned_deg=1)),
    ("1000 kg on 1 kg, sinks 10 mm", ("mass_1000",), within(sinks_mm=10, leans_deg=1, drift_mm=10)),
    ("tower of 10 stands, 0.01 m/s", ("tower_10",), within(sinks_mm=50, leans_deg=1, drift_mm=10, end_speed=0.01)),
    ("tower of 20 stands, 0.01 m/s", ("tower_20",), within(sinks_mm=50, leans_deg=1, drift_mm=10, end_speed=0.01)),
    ("grip holds for 60 s, 5 mm, 5°", ("grip",), within(fell_mm=5, turned_deg=5)),
    ("grip on a pendulum holds for 20 s, 5 mm, 5°", ("grip_shaken",), within(slipped_mm=5, turned_deg=5)),
    ("cart slides, then rolls, 1 %", ("cart",), lambda m: abs(m["off_mm"]) <= 0.01 * m["truth_mm"] and m["aside_mm"] <= 0.01 * m["truth_mm"]),
    ("peg goes into its hole, 1 mm", ("peg",), within(left_mm=1, leans_deg=1, overlap_mm=1)),
    ("nut locks itself, 0.1 mm/s", ("nut_rests",), within(creep_mm_s=0.1, off_mm=1, leans_deg=1)),
    ("nut runs down its thread, 1 % of its way", ("nut_runs",),
     lambda m: abs(m["off_mm"]) <= 0.01 * m["truth_mm"] and m["off_thread_mm"] <= 0.01 * m["truth_mm"]),
    ("feet walk, 1 % of their way, slip 1 mm", ("feet",),
     lambda m: max(abs(m["off_mm"]), m["aside_mm"]) <= 0.01 * m["truth_mm"] and m["slip_mm"] <= 1 and m["turned_deg"] <= 1),
    ("100 kg on a rope of 0.1 kg bars, 10 mm", ("rope",), within(gap_mm=10)),
    ("humanoid lies, overlap 10 mm", ("humanoid_falls",), within(rest_mm=10)),
    ("50 bodies in a pile, overlap 10 mm", ("pile_50",), within(rest_mm=10)),
    ("27 capsules, overlap 10 mm", ("capsules_27",), within(rest_mm=10)),
)


def eased(measures, factor):
    """As they are to bounds `factor` times as wide."""
    return {name: m if name == "truth_mm" else m / factor for name, m in measures.items() if m is not None}


def verdict_of(run, asked, refused, factor=1.0):
    """Of one run; None where there is none."""
    if run is None:
        return None
    if run["end"] == "cannot express":
        return "cannot"
    if run["end"] in ("crashed", "diverged"):
        return "diverged"
    if refused:
        return "refused"
    if run["end"] == "late":
        return "late"
    try:
        return "held" if asked(eased(run["judged"]["measures"], factor)) else "missed"
    except KeyError:
        return "missed"


WORST = ("refused", "diverged", "late", "missed", "cannot", "held")


def verdict(case, entry, runs, refusals, factor=1.0):
    """Of a case: the worst of its scenes, with bounds `factor` times as wide. `runs` by (scene, entry, h)."""
    _, scenes, asked = case
    found = []
    for scene in scenes:
        h = plan.REFERENCE_STEP if entry.engine == "simbody" and scene in plan.SMOOTH else plan.STEP
        key = scene, entry.key, h
        found.append(verdict_of(runs.get(key), asked, refusals.get(key), factor))
    found = [v for v in found if v]
    return min(found, key=WORST.index) if found else None
