# SPDX-License-Identifier: Apache-2.0
"""The page of the study beside other engines: what is kept of it where a part is run again."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "apps/rivals"))
import gate  # noqa: E402
import kept  # noqa: E402
import page  # noqa: E402
import plan  # noqa: E402
import verdicts  # noqa: E402


def test_a_study_of_nothing_leaves_the_page_as_it_is(tmp_path):
    text = (ROOT / "docs/rivals.md").read_text()
    assert page.Page(tmp_path, ROOT / "docs/rivals/results.csv").fill(text).splitlines() == text.splitlines()


def test_what_ran_again_takes_the_place_of_what_is_kept(tmp_path):
    key = "tower_10", "ode", plan.STEP
    fresh = {key: {"scene": key[0], "entry": key[1], "h": key[2], "end": "done", "version": "ODE 1.0", "judged": {"measures": {"sinks_mm": 7.0}}}}
    runs = kept.read(ROOT / "docs/rivals/results.csv", fresh)
    assert key not in runs and ("tower_10", "dart", plan.STEP) in runs
    assert not any(k[1].split()[0] == "ode" for k in runs)  # of another version
    kept.write(tmp_path / "results.csv", {**runs, **fresh}, {})
    again = kept.read(tmp_path / "results.csv", {})
    assert again[key]["judged"] == fresh[key]["judged"] and len(again) == len(runs) + 1


def test_a_wider_bound_holds_what_is_off_by_less():
    run = {"end": "done", "judged": {"measures": {"off_mm": 6.0, "aside_mm": 0.0, "truth_mm": 400.0}}}
    asked = next(c[2] for c in verdicts.CASES if c[1] == ("cart",))  # 1 % of 400 mm
    assert [verdicts.verdict_of(run, asked, None, f) for f in (1, 1.4, 2)] == ["missed", "missed", "held"]


def test_a_scene_that_ends_elsewhere_where_it_is_written_again_is_refused():
    run = {"scene": plan.SECOND_SCENE, "entry": "ode", "end": "done", "mass": 1.0, "judged": {
        "gate": {"overlap_at_start": 0.0, "start_error": 0.0, "mass": 1.0}, "measures": {"second_m": 1e-6}}}
    assert gate.refusal_of_run(run) is None
    run["judged"]["measures"]["second_m"] = 1e-4
    assert "second time" in gate.refusal_of_run(run)
