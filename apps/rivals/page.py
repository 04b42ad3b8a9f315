# SPDX-License-Identifier: Apache-2.0
"""Writes what the study has found: page.py FOLDER DOCS [--keep].

FOLDER is that of study.py. Of DOCS/rivals.md what stands between `<!-- NAME -->` and `<!-- end -->` is
written anew; DOCS/rivals/ gets all results as results.csv and the pictures. --keep, for a study of a part:
what FOLDER lacks stays as results.csv and times.csv have it.
"""
import argparse
import json
import pathlib
import re

import gate
import kept
import pictures
import plan
import times
import verdicts

RED = "🔴 "


def load(folder):
    """Runs by (scene, entry, step); the last of each counts."""
    path = folder / "results.jsonl"
    lines = path.read_text().splitlines() if path.exists() else []
    return {(r["scene"], r["entry"], r["h"]): r for r in map(json.loads, lines)}


class Page:
    def __init__(self, folder, earlier=None):
        self.keeps = earlier is not None
        self.runs = load(folder)
        if self.keeps:
            # What was late for a quicker study says nothing of a whole one.
            self.runs = {k: r for k, r in self.runs.items() if r["end"] != "late" or r.get("most", plan.MOST) >= plan.MOST}
            self.runs.update(kept.read(earlier, self.runs))
        path = folder / "second.json"
        for engine, s in json.loads(path.read_text()).items() if path.exists() else ():
            run = self.runs.get((plan.SECOND_SCENE, self.first(engine).key, plan.STEP))
            if run:
                run["judged"]["measures"]["second_m"] = s["distance_m"]
        self.refusals = gate.refusals(list(self.runs.values()))
        self.times = times.read(folder)
        if earlier:
            self.times = times.merged(self.times, times.kept(earlier.parent / "times.csv"))

    @staticmethod
    def first(engine):
        return next(e for e in plan.ENTRIES if e.engine == engine)

    def present(self, kind):
        """Columns of a kind of table: those that have run."""
        entries = {key[1] for key in self.runs}
        return [e for e in plan.ENTRIES if e.key in entries and (not e.scenes or kind in e.scenes)]

    def measures(self, scene, entry, h=plan.STEP):
        """Of a run; or a word on why there are none."""
        if entry.engine == "simbody" and scene in plan.SMOOTH:
            h = plan.REFERENCE_STEP
        run, why = self.runs.get((scene, entry.key, h)), self.refusals.get((scene, entry.key, h))
        if run is None:
            return "–"
        if run["end"] == "cannot express":
            return "cannot"
        if run["end"] == "crashed":
            return "crashes"
        if why:
            return "refused"
        if run["end"] in ("diverged", "late"):
            return f"diverges at {run['time']:.2g} s" if run["end"] == "diverged" else "too slow"
        return run["judged"]["measures"]

    def cell(self, scene, entry, *names, h=plan.STEP, style="{:.3g}"):
        m = self.measures(scene, entry, h)
        return m if isinstance(m, str) else ", ".join(style.format(m[n]) for n in names)

    # ---- Tables ------------------------------------------------------------------------------

    def table(self, head, rows):
        lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
        return lines + ["| " + " | ".join(r) + " |" for r in rows]

    def versions(self):
        rows = []
        for engine in dict.fromkeys(e.engine for e in plan.ENTRIES):
            found = {r["version"] for k, r in self.runs.items() if k[1].split()[0] == engine and "version" in r}
            entries = [e for e in plan.ENTRIES if e.engine == engine and e.role != "gate"]
            columns = "; ".join(f"{e.label}: " + (f"`{' '.join(e.settings)}`" if e.settings else "no setting")
                                + (f" ({e.source})" if e.source else "") for e in entries)
            rows.append([", ".join(sorted(found)) or f"{engine}: not found", columns])
        return self.table(["engine", "columns"], rows)

    def line(self):
        """Who is on the page, in one line."""
        versions = [r["version"] for r in self.runs.values() if "version" in r]
        return [", ".join(dict.fromkeys(sorted(versions))) + "."]

    def smooth(self, scene):
        rows = []
        for e in self.present("smooth"):
            if e.role == "gate":
                continue
            if e.engine == "simbody":
                rows.append([e.label, self.cell(scene, e, "error_m")] + ["" for _ in plan.STEPS[1:]])
            else:
                rows.append([e.label] + [self.cell(scene, e, "error_m", h=h) for h in plan.STEPS])
        return self.table(["error [m]"] + [f"{1e3 * h:g} ms" for h in plan.STEPS], rows)

    def drift(self):
        rows = [[e.label, self.cell("chain_10_long", e, "energy_percent"),
                 self.cell("top", e, "tilt_low_deg", "tilt_high_deg", style="{:.2f}"),
                 self.cell("free_body", e, "energy_percent"), self.cell("free_body", e, "momentum"),
                 self.cell("thrown_body", e, "parabola_mm")] for e in self.present("drift")]
        return self.table(["", "chain of 10: energy [%]", "top: tilt [°], true 20.00, 55.46", "free body at 50 rad/s: energy [%]",
                           "momentum, relative", "thrown body: off its parabola [mm]"], rows)

    def published(self):
        """Of each scene of others: what they published, and what came out here."""
        rows = []
        for e in plan.ENTRIES:
            if e.role == "gate" or e.key not in {key[1] for key in self.runs}:
                continue
            cells = []
            for scene, (names, figures) in plan.PUBLISHED.items():
                there = ", ".join(f"{x:.3g}" for x in figures.get(e.label, ()))
                cells += [there, self.cell(scene, e, *names, h=plan.PUBLISHED_STEP) if plan.takes_part(e, scene) else ""]
            rows.append([e.label] + cells)
        return self.table(["", "box `complex`: off the parabola [mm], angular momentum, relative, published", "here",
                           "ball that bounces for ever: energy, mean square [J²], published", "here",
                           "25 balls on a pushed box: velocities, mean square [m²/s²], published", "here"], rows)

    def thrown(self):
        rows = []
        for e in self.present("friction"):
            cells = []
            for speed in plan.scenes.SPEEDS:
                all_ = [self.measures(s, e) for s in plan.THROWN if s.startswith(f"thrown_{speed:g}_")]
                found = [m for m in all_ if not isinstance(m, str)]
                if not found:
                    cells.append(all_[0])
                    continue
                off = max((m["off_percent"] for m in found), key=abs)
                aside = max(100 * m["aside_mm"] / m["truth_mm"] for m in found)
                turned = max(m["turned_deg"] for m in found)
                cells.append(f"{off:+.2g}, {aside:.2g}" + (f", turns {turned:.2g}°" if turned > 1 else "")
                             + (f" (of {len(found)})" if len(found) < len(all_) else ""))
            cells.append(self.cell("thrown_2_37", e, "off_mm", "aside_mm", "lifted_mm"))
            cells.append(self.cell("thrown_2_37", e, "off_mm", "aside_mm", "lifted_mm", h=0.01))
            rows.append([e.label] + cells)
        return self.table(["off [%], aside [%], worst of eight directions"] + [f"{s:g} m/s" for s in plan.scenes.SPEEDS]
                          + ["2 m/s at 37°: off, aside, lifted [mm]", "the same at 10 ms"], rows)

    def friction(self):
        rows = [[e.label, self.cell("slides_37", e, "off_mm"), self.cell("creep_15", e, "creep_mm_s"),
                 self.cell("creep_50", e, "creep_mm_s"), self.cell("creep_99", e, "creep_mm_s"),
                 self.cell("creep_99_askew", e, "creep_mm_s", "aside_mm_s"),
                 self.cell("rolling", e, "off_mm", "slip_percent")] for e in self.present("friction")]
        return self.table(["", "slides down 37° for 1 s, off its 993.2 mm [mm]", "creep on 15°, μ 1 [mm/s]",
                           "at half the cone [mm/s]", "at 99 % of the cone [mm/s]", "at 99 %, slope askew by 37°: down, aside [mm/s]",
                           "ball slides, then rolls: off [mm], slips [%]"], rows)

    def bounce(self):
        """Of every body and restitution: the three heights. The truth is in the head."""
        rows = [[e.label] + [self.cell(s, e, "top1_mm", "top2_mm", "top3_mm", style="{:.0f}") for s in plan.BOUNCE]
                + [self.cell("bounce_ball_80", e, "deepest_mm")] for e in self.present("bounce")]
        names = []
        for s in plan.BOUNCE:
            kind, e = s.split("_")[1], float(s.split("_")[2]) / 100
            names.append(f"{kind}, e = {e:g}: " + ", ".join(f"{1000 * e ** (2 * n):.0f}" for n in (1, 2, 3)))
        return self.table(["heights [mm]"] + names + ["deepest, ball, e = 0.8"], rows)

    def machines(self):
        rows = [[e.label, self.cell("nut_rests", e, "off_mm", "creep_mm_s"), self.cell("nut_runs", e, "off_mm", "aside_mm"),
                 self.cell("nut_runs", e, "off_mm", "aside_mm", h=0.0005),
                 self.cell("feet", e, "off_mm", "aside_mm", "turned_deg", "slip_mm")] for e in self.present("hold")]
        return self.table(["", "nut that locks, 10 s: sinks [mm], then [mm/s]", "nut that runs down 17.5 mm: off, aside [mm]", "the same at 0.5 ms",
                           "feet walk 270 mm: off, aside [mm], turn [°], slip [mm]"], rows)

    def hold(self):
        rows = [[e.label, self.cell("mass_1000", e, "sinks_mm", "leans_deg"), self.cell("tower_10", e, "sinks_mm", "leans_deg"),
                 self.cell("tower_20", e, "sinks_mm", "leans_deg"), self.grip(e),
                 self.cell("rope", e, "gap_mm", "energy_percent"), self.cell("humanoid_falls", e, "rest_mm"),
                 self.cell("pile_50", e, "rest_mm", "end_kinetic"), self.cell("capsules_27", e, "rest_mm", "end_kinetic")]
                for e in self.present("hold")]
        return self.table(["", "1000 kg on 1 kg: sinks [mm], leans [°]", "tower of 10: top sinks, leans", "tower of 20",
                           "grip, 60 s: falls [mm], then [µm/s]", "rope: widest gap [mm], energy off [%]", "humanoid lies: overlap [mm]",
                           "pile of 50: overlap [mm], energy left [J]", "27 capsules: overlap, energy"], rows)

    def work(self):
        """What moves and is held at the same time."""
        rows = [[e.label, self.shaken(e), self.cell("cart", e, "off_mm", "aside_mm"), self.cell("peg", e, "left_mm", "leans_deg", "overlap_mm")]
                for e in self.present("hold")]
        return self.table(["", "grip on a pendulum, 20 s: slips [mm], turns [°]", "cart rolls for 10 s: off, aside [mm]",
                           "peg in its hole: above the ground [mm], leans [°], deepest in a wall [mm]"], rows)

    def shaken(self, entry):
        m = self.measures("grip_shaken", entry)
        if isinstance(m, str):
            return m
        return "lost" if m["lost"] > 0 else f"{m['slipped_mm']:.2g}, {m['turned_deg']:.2g}"

    def grip(self, entry):
        m = self.measures("grip", entry)
        if isinstance(m, str):
            return m
        return f"lost at {m['lost_s']:.2g} s" if m["lost_s"] >= 0 else f"{m['fell_mm']:.2g}, {m['creep_um_s']:.2g}"

    def softness(self):
        rows = [[e.label] + [self.cell("drop", e, name) for name in ("deepest_mm", "rebound_mm", "rest_mm")]
                for e in self.present("softness")]
        return self.table(["a ball of 1 kg from 1 m", "deepest [mm]", "rebound [mm]", "at rest [mm]"], rows)

    WORDS = {"held": "held", "missed": RED + "missed", "diverged": RED + "diverged", "late": RED + "too slow", "cannot": "cannot",
             "refused": "refused", None: "–"}
    # A column of the matrix: its entry for contacts, and for smooth motion.
    MATRIX = {"ours": ("ours", "ours"), "ours, elliptic": ("ours, elliptic", "ours"), "MuJoCo": ("MuJoCo", "MuJoCo"),
              "MuJoCo, best": ("MuJoCo, elliptic, noslip", "MuJoCo, RK4"), "DART": ("DART", "DART"), "DART, best": ("DART, PGS", "DART"),
              "Bullet, library": ("Bullet, library", "Bullet"), "Bullet, best": ("Bullet", "Bullet, RK4"), "ODE": ("ODE", "ODE"),
              "ODE, quick": ("ODE, quick", "ODE, quick"), "Simbody": ("Simbody", "Simbody"),
              "Simbody, best": ("Simbody, 1e-5", "Simbody, 1e-5"), "Rapier": ("Rapier", "Rapier"), "Rapier, best": ("Rapier, 8 iterations", "Rapier, 8 iterations"),
              "Jolt": ("Jolt", "Jolt"), "Jolt, best": ("Jolt, 50 iterations", "Jolt, 50 iterations")}

    def matrix_columns(self):
        """Those that have run, each with its two entries."""
        labels = {e.label: e for e in plan.ENTRIES if e.key in {k[1] for k in self.runs}}
        return {name: (labels[c], labels[s]) for name, (c, s) in self.MATRIX.items() if c in labels and s in labels}

    def verdict(self, case, column, factor=1.0):
        entry = column[0 if plan.kind_of(case[1][0]) in plan.CONTACT else 1]
        found = verdicts.verdict(case, entry, self.runs, self.refusals, factor)
        npm = [e for e in plan.ENTRIES if (e.engine, e.settings) == (entry.engine + "_npm", entry.settings)]
        # Where an engine has not run natively, as npm has it.
        return found or (verdicts.verdict(case, npm[0], self.runs, self.refusals, factor) if npm else None)

    def matrix(self):
        columns = self.matrix_columns()
        rows = [[case[0]] + [self.WORDS[self.verdict(case, c)] for c in columns.values()] for case in verdicts.CASES]
        return self.table(["at 2 ms", *columns], rows)

    def sensitivity(self):
        """How many cases each column holds with narrower and wider bounds."""
        columns = self.matrix_columns()
        count = lambda c, f: sum(self.verdict(case, c, f) == "held" for case in verdicts.CASES)
        return self.table(["cases held", *columns],
                          [[f"bounds × {f:g}"] + [str(count(c, f)) for c in columns.values()] for f in (0.1, 0.5, 1, 2, 10)])

    def gate(self):
        none = sum(r["end"] in ("cannot express", "crashed") for r in self.runs.values())
        lines = [f"Passed: {len(self.runs) - len(self.refusals) - none} of {len(self.runs)} runs; {none} were none."]
        if not gate.references(list(self.runs.values())):
            lines.append("Simbody was not there: errors of smooth motion are from our own reference, without a second one.")
        for scene, distance in gate.references(list(self.runs.values())).items():
            lines.append(f"The two references of `{scene}` differ by {distance:.2g} m (root mean square).")
        for e in map(self.first, plan.SECOND):
            m = self.measures(plan.SECOND_SCENE, e)
            if "second_m" in m:
                lines.append(f"`{plan.SECOND_SCENE}` of {e.label}, written a second time: {1e3 * m['second_m']:.1g} mm from the study's run.")
        by = {}
        for (scene, entry, _), why in self.refusals.items():
            by.setdefault((entry.split()[0], re.sub(r"[\d.e+-]+", "…", why)), []).append((scene, why))
        for (engine, _), found in sorted(by.items()):
            lines.append(f"Refused of {engine}: {', '.join(sorted({s for s, _ in found}))}: {found[0][1]}.")
        said = lambda r: r.get("why", "")[max(r.get("why", "").find("Assertion"), 0):][:100]
        label = {e.key: e.label for e in plan.ENTRIES}
        failed = sorted({(label.get(r["entry"], r["entry"]), r["scene"], said(r)) for r in self.runs.values() if r["end"] in ("cannot express", "crashed")})
        for why in sorted({(e, w) for e, _, w in failed}):
            found = sorted({s for e, s, w in failed if (e, w) == why})
            lines.append(f"No run of {why[0]}: {', '.join(found)}: {why[1]}.")
        return ["- " + l for l in lines]

    def time_table(self):
        """Medians and ranges of CPU time a step over that of the calibration beside it, by scene; None: as they were."""
        found = times.figures(self.times)
        rows = [(scene, e, found[scene, e.key, plan.STEP]) for scene in plan.TIMED for e in plan.ENTRIES if (scene, e.key, plan.STEP) in found]
        if not rows:
            return None if self.keeps else ["Not measured in this run of the study: `./dev rivals` times after the errors, on a machine that does nothing else."]
        load = max(f.load for _, _, f in rows)
        lines = self.table(["scene", "column", "a step, times the calibration: median (least to most)", "µs a step", "rounds", "end"],
                           [[s, e.label, f"{f.median:.3g} ({f.ratios[0]:.3g} to {f.ratios[-1]:.3g})", f"{f.median * f.calibration_us:.3g}",
                             str(len(f.ratios)), f.end] for s, e, f in rows])
        return lines + ["", f"Largest median load of the machine: {load:.2g}" + ("; above 1.5 these figures say little." if load > 1.5 else ".")]

    def slower(self):
        """Where a column of ours by default takes more than 1.1 times another's time for a step."""
        found = times.figures(self.times)
        lines = []
        for scene in plan.TIMED + plan.SIZED:
            ours = found.get((scene, "ours", plan.STEP))
            others = [(e.label, ours.median / found[scene, e.key, plan.STEP].median) for e in plan.ENTRIES
                      if e.engine != "ours" and ours and (scene, e.key, plan.STEP) in found]
            over = "; ".join(f"{ratio:.2g} of {label}" for label, ratio in others if ratio > 1.1)
            if over:
                lines.append(f"- {RED}`{scene}`: {over}")
        return lines or (None if self.keeps else ["Not measured in this run of the study."])

    SECTIONS = {"line": line, "versions": versions, "gate": gate, "chain_20": lambda s: s.smooth("chain_20"),
                "humanoid_in_the_air": lambda s: s.smooth("humanoid_in_the_air"), "drift": drift, "published": published, "thrown": thrown, "friction": friction, "bounce": bounce,
                "hold": hold, "work": work, "machines": machines, "softness": softness, "matrix": matrix, "sensitivity": sensitivity, "slower": slower, "times": time_table}

    def fill(self, text):
        for name, make in self.SECTIONS.items():
            lines = make(self)
            if lines is None:
                continue
            content = "\n".join(lines)
            text = re.sub(rf"(<!-- {name} -->\n).*?(<!-- end -->)", lambda m: m[1] + content + "\n" + m[2], text, flags=re.S)
        return text


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("docs", type=pathlib.Path)
    parser.add_argument("--keep", action="store_true")
    arguments = parser.parse_args()
    docs = arguments.docs
    (docs / "rivals").mkdir(parents=True, exist_ok=True)
    results = docs / "rivals/results.csv"
    page = Page(arguments.folder, results if arguments.keep else None)
    kept.write(results, page.runs, page.refusals)
    if page.times:
        times.write(results.parent / "times.csv", page.times)
    pictures.draw(page, docs / "rivals")
    text = docs / "rivals.md"
    text.write_text(page.fill(text.read_text()))


if __name__ == "__main__":
    main()
