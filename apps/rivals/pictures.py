# SPDX-License-Identifier: Apache-2.0
"""Pictures of the study: error against the step and against time, what held, how far thrown boxes go, and time against size."""
import math

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

import plan
import times
import verdicts

matplotlib.rcParams.update({"font.size": 9, "svg.hashsalt": "softgauss", "svg.fonttype": "none", "axes.spines.top": False, "axes.spines.right": False})
INK = {"ours": "#0b6e75", "ours, elliptic": "#e07b39", "ours, RK4": "#5fb3b3", "ours, Dormand-Prince 1e-5": "#e07b39",
       "MuJoCo": "#d9534f", "MuJoCo, elliptic, noslip": "#c27ba0", "Bullet": "#7a5195", "Bullet, RK4": "#7a5195", "ODE": "#7f8c8d"}
SIZE_INK = {"ours": "#0b6e75", "MuJoCo": "#d9534f", "DART": "#7a5195", "Bullet, library": "#e07b39", "ODE": "#7f8c8d", "ODE, quick": "#b3b9ba"}
COLOURS = {"held": "#7fbf8e", "missed": "#d9534f", "diverged": "#8c2d2a", "late": "#b0763f", "cannot": "#d8d8d8",
           "refused": "#ffffff", None: "#ffffff"}
# At most six curves a picture, each labelled at its end: of motion, and of contact.
CURVES = ("ours", "ours, RK4", "ours, Dormand-Prince 1e-5", "MuJoCo", "Bullet, RK4", "ODE")
CONTACT_CURVES = ("ours", "ours, elliptic", "MuJoCo", "MuJoCo, elliptic, noslip", "Bullet", "ODE")


def save(figure, path):
    figure.savefig(path, metadata={"Date": None}, bbox_inches="tight")
    plt.close(figure)


def apart(heights, least):
    """Heights in order, moved up so that labels do not lie on one another (in decades)."""
    out = []
    for h in heights:
        out.append(max(h, out[-1] + least) if out else h)
    return out


def decades(axes):
    low, high = axes.get_ylim()
    return math.log10(high / low)


def label(axes, ends, x, least):
    """Names curves at their ends, (height, name, colour); heights are decades where the axis is logarithmic."""
    ends.sort()
    for y, (_, name, colour) in zip(apart([e[0] for e in ends], least), ends):
        axes.annotate(name, (x, 10 ** y if axes.get_yscale() == "log" else y), color=colour, va="center", annotation_clip=False)


def work(page, scene, path):
    """Error over the step, and over the CPU time that it takes."""
    measure, axis, title = plan.WORK[scene]
    curves = CURVES if plan.kind_of(scene) in plan.MOTION else CONTACT_CURVES
    found = times.figures(page.times)
    figure, panels = plt.subplots(1, 2, figsize=(9.6, 3.6), sharey=True, gridspec_kw={"wspace": 0.7})
    ends = ([], [])
    for entry in page.present(plan.kind_of(scene)):
        if entry.label not in curves:
            continue
        errors = {h: abs(m[measure]) for h in plan.STEPS if not isinstance(m := page.measures(scene, entry, h), str)}
        cost = {h: found[scene, entry.key, h].median / h for h in errors if (scene, entry.key, h) in found}
        colour = None
        for axes, at, points in zip(panels, ends, ([(1e3 * h, e) for h, e in errors.items()], [(cost[h], errors[h]) for h in cost])):
            if not points:
                continue
            line, = axes.loglog(*zip(*points), "o-", ms=3, lw=1.2, color=colour or INK.get(entry.label))
            colour = line.get_color()
            at.append((math.log10(points[0 if axes is panels[0] else -1][1]), entry.label, colour))
    for axes, at in zip(panels, ends):
        right = 1.15 * max(x for line in axes.lines for x in line.get_xdata()) if axes.lines else 1
        label(axes, at, right, 0.055 * decades(axes))
    panels[0].set_xlabel("step [ms]")
    panels[0].set_ylabel(axis)
    panels[0].set_title(title, loc="left", fontsize=9)
    panels[0].set_xticks([1e3 * h for h in plan.STEPS], [f"{1e3 * h:g}" for h in plan.STEPS])
    panels[0].minorticks_off()
    panels[1].set_xlabel("CPU time of a second, times the calibration")
    save(figure, path)


def matrix(page, path):
    columns = page.matrix_columns()
    figure, axes = plt.subplots(figsize=(0.72 * len(columns) + 3.2, 0.27 * len(verdicts.CASES) + 1.2))
    words = {"held": "", "missed": "missed", "diverged": "diverged", "late": "slow", "cannot": "cannot", "refused": "–", None: "–"}
    for row, case in enumerate(verdicts.CASES):
        for column, entries in enumerate(columns.values()):
            v = page.verdict(case, entries)
            axes.add_patch(plt.Rectangle((column, row), 0.96, 0.9, color=COLOURS[v], lw=0))
            axes.text(column + 0.48, row + 0.45, words[v], ha="center", va="center", fontsize=6.5,
                      color="white" if v in ("missed", "diverged", "late") else "#555555")
    axes.set_xlim(0, len(columns))
    axes.set_ylim(len(verdicts.CASES), 0)
    axes.set_xticks([i + 0.48 for i in range(len(columns))], [name.replace(", ", ",\n") for name in columns], fontsize=7.5)
    axes.xaxis.tick_top()
    axes.set_yticks([i + 0.45 for i in range(len(verdicts.CASES))], [c[0] for c in verdicts.CASES], fontsize=7.5)
    axes.tick_params(length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
    save(figure, path)


def thrown(page, path):
    """Where boxes stop that are thrown at 2 m/s, over the direction."""
    labels = ("ours", "ours, elliptic", "MuJoCo", "DART", "Bullet", "ODE")
    entries = [e for e in page.present("friction") if e.label in labels]
    figure, axes = plt.subplots(figsize=(6.0, 3.2))
    ends = []
    for entry in entries:
        points = [(a, m["off_percent"]) for a in plan.scenes.DIRECTIONS
                  if not isinstance(m := page.measures(f"thrown_2_{a:g}", entry), str)]
        if points:
            line, = axes.plot(*zip(*points), "o:", ms=4, lw=0.7, color=INK.get(entry.label))
            ends.append((points[-1][1], entry.label, line.get_color()))
    label(axes, ends, 308, 5.5)
    axes.axhline(0, color="#aaaaaa", lw=0.8, zorder=0)
    axes.set_xlabel("direction of the throw [°]")
    axes.set_ylabel("too far [%]")
    axes.set_xticks(plan.scenes.DIRECTIONS, [f"{a:g}" for a in plan.scenes.DIRECTIONS], fontsize=7)
    axes.set_title("a box thrown at 2 m/s, friction 0.5: from where Coulomb's law stops it", loc="left", fontsize=9)
    save(figure, path)


def size(page, path):
    """Time a step over the number of bodies, of chains, towers and piles."""
    found = times.figures(page.times)
    if not all(any((f"{name}_{n}", page.first("ours").key, plan.STEP) in found for n in plan.scenes.SIZES[name]) for name in plan.scenes.SIZES):
        return
    figure, panels = plt.subplots(1, len(plan.scenes.SIZES), figsize=(9.6, 3.2), gridspec_kw={"wspace": 0.75})
    for axes, (name, sizes) in zip(panels, plan.scenes.SIZES.items()):
        ends = []
        for entry in plan.ENTRIES:
            # A chain is of Bullet's trees, which both of its columns step alike.
            column = "Bullet, library" if (name, entry.label) == ("chain", "Bullet") else entry.label
            keys = {n: (f"{name}_{n}", entry.key, plan.STEP) for n in sizes}
            points = [(n, found[key].median) for n, key in keys.items() if key in found]
            if column not in SIZE_INK or not points:
                continue
            line, = axes.loglog(*zip(*points), "o-", ms=3, lw=1.2, color=SIZE_INK[column])
            ends.append((math.log10(points[-1][1]), column, line.get_color()))
        label(axes, ends, 1.1 * sizes[-1], 0.07 * decades(axes))
        axes.set_xticks(sizes, [str(n) for n in sizes])
        axes.minorticks_off()
        axes.set_xlabel({"chain": "links of a chain", "tower": "cubes of a tower", "pile": "bodies that fall"}[name])
    panels[0].set_ylabel("a step, times the calibration")
    save(figure, path)


def draw(page, folder):
    for scene in plan.WORK:
        work(page, scene, folder / f"{scene}.svg")
    matrix(page, folder / "matrix.svg")
    thrown(page, folder / "thrown.svg")
    size(page, folder / "size.svg")
