# SPDX-License-Identifier: Apache-2.0
"""Whether two sessions of times agree, by how far each spreads (apps/rivals/times.py)."""
import itertools
import json
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "apps/rivals"))
import times  # noqa: E402


def session(number, ratios):
    """Rounds of one figure: ratios to a calibration that drifts, as a machine's clock does."""
    return [{"scene": "tower", "entry": "ours", "h": 0.002, "session": number, "round": k, "end": "done", "us_a_step": ratio * clock,
             "calibration_us": clock, "load": 0.1} for k, (ratio, clock) in enumerate(zip(ratios, itertools.count(3.5, 0.7)))]


def test_figures_are_ratios_to_the_calibration_beside_them():
    figure = times.figures(session(1, [5.0, 5.2, 5.1]))["tower", "ours", 0.002]
    assert [round(r, 9) for r in figure.ratios] == [5.0, 5.1, 5.2]
    assert abs(figure.median - 5.1) < 1e-9


def test_ranges_that_meet_agree_and_others_are_named():
    first = session(1, [5.0, 5.2, 5.1])
    lines, holds = times.compare(first, session(2, [5.3, 5.15, 5.4]))
    assert holds and lines[-1].startswith("0 of 1")
    lines, _ = times.compare(first, session(2, [5.3, 5.25, 5.4]))
    assert lines[0].startswith("tower, ours, 2 ms: 5.1 and 5.3") and lines[-1].startswith("1 of 1")


def test_chance_is_that_of_samples_of_one_distribution():
    r = random.Random(1)
    draw = lambda: times.figures(session(1, [1 + r.random() for _ in range(3)]))["tower", "ours", 0.002]
    apart = sum(not draw().meets(draw()) for _ in range(4000)) / 4000
    one = draw()
    assert times.by_chance(one, one) == 0.1  # of the 20 orders of three and three, two keep them apart
    assert abs(apart - 0.1) < 0.015  # three standard deviations of 4000 draws


def test_sessions_of_one_folder_are_told_apart(tmp_path):
    runs = session(1, [5.0, 5.2]) + session(2, [5.1, 5.3])
    (tmp_path / "times.jsonl").write_text("".join(json.dumps(r) + "\n" for r in runs))
    assert [len(s) for s in times.sessions(times.read(tmp_path))] == [2, 2]


def test_what_is_kept_is_read_again_and_gives_way_to_a_scene_that_is_timed_anew(tmp_path):
    runs = session(1, [5.0, 5.2]) + session(2, [5.1, 5.3])
    times.write(tmp_path / "times.csv", runs)
    again = times.kept(tmp_path / "times.csv")
    assert [(r["session"], r["round"]) for r in again] == [(1, 0), (1, 1), (2, 0), (2, 1)]
    figure, before = (times.figures(rs)["tower", "ours", 0.002] for rs in (again, runs))
    assert all(abs(a / b - 1) < 1e-4 for a, b in zip(figure.ratios, before.ratios))  # five digits
    new = [{**r, "entry": "ode"} for r in session(3, [2.0])]
    assert times.merged(new, again) == new  # of the same scene
    assert times.merged([{**new[0], "scene": "feet"}], again)[1:] == again
    assert times.kept(tmp_path / "none.csv") == []
