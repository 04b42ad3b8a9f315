# SPDX-License-Identifier: Apache-2.0
"""Runs the study beside other engines: study.py PROGRAMS FOLDER [--quick] [--only PATTERN] [--times ROUNDS].

Each run is a process of its own. What has run with these programs and scenes is not run again, so that
a study may be interrupted. FOLDER/results.jsonl holds a line a run, FOLDER/times.jsonl one a timed run (times.py).
"""
import argparse
import hashlib
import json
import math
import os
import pathlib
import re
import subprocess
import time
from array import array
from concurrent.futures import ThreadPoolExecutor, as_completed

import plan
import scenes
import times

HERE = pathlib.Path(__file__).parent


class Study:
    def __init__(self, programs, folder, most):
        self.programs, self.folder, self.most = programs, folder, most
        self.hashes = {}
        (folder / "states").mkdir(parents=True, exist_ok=True)
        scenes.main(folder / "scenes", [])

    def program(self, engine):
        """The command of an engine, or None where it was not built."""
        if engine.endswith("_npm"):
            packages = self.folder / "npm/node_modules"
            return ["node", str(HERE / "engines/npm.mjs"), str(packages), engine[:-4]] if packages.exists() else None
        path = self.programs / f"rivals_{engine}"
        return [str(path)] if path.exists() else None

    def hash(self, *paths):
        """Of files: what a run depends on."""
        for path in paths:
            if path not in self.hashes:
                self.hashes[path] = hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()[:12]
        return "-".join(self.hashes[p] for p in paths)

    def origin(self, scene, entry):
        code = self.program(entry.engine)
        files = sorted(HERE.glob("engines/npm*.mjs")) if entry.engine.endswith("_npm") else [pathlib.Path(code[0])]
        return self.hash(self.folder / f"scenes/{scene}.json", *files)

    def states(self, scene, entry, h):
        name = f"{scene}_{entry.key}_{h:g}".replace(" ", "_").replace("=", "-")
        return self.folder / "states" / name

    def run(self, scene, entry, h, least=0.0, most=None):
        """One process, of at least and at most so much CPU time [s]. What it says, or why it ended."""
        command = [*self.program(entry.engine), str(self.folder / f"scenes/{scene}.json"),
                   str(self.states(scene, entry, h)), repr(h), "--least", str(least), "--most", str(most or self.most),
                   *entry.settings]
        # CPU time is looked at by the program itself. This is for what hangs, on a machine however busy;
        # a limit of the process (RLIMIT_CPU) would make its CPU clock count by ticks.
        if entry.role == "reference":
            command[command.index("--most") + 1] = "600"
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=3600)
        except subprocess.TimeoutExpired:
            return {"end": "late", "why": "no end within an hour"}
        lines = done.stdout.strip().splitlines()
        if done.returncode == 0 and lines:
            return json.loads(lines[-1])
        why = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
        return {"end": "crashed", "why": why[max(why.find("Assertion"), 0):][:120]}

    def reference(self, scene):
        """The entry whose states a smooth scene is judged by: the first that has run."""
        return next((e for e in plan.REFERENCES if scene in plan.SMOOTH
                     and self.states(scene, e, plan.REFERENCE_STEP).exists()), None)

    def judge(self, scene, entry, h):
        reference = self.reference(scene)
        command = [str(self.programs / "rivals_judge"), str(self.folder / f"scenes/{scene}.json"),
                   str(self.states(scene, entry, h))]
        if reference and entry is not reference:
            command.append(str(self.states(scene, reference, plan.REFERENCE_STEP)))
        done = subprocess.run(command, capture_output=True, text=True)
        return json.loads(done.stdout) if done.returncode == 0 else {"why": done.stderr.strip()}

    def result(self, scene, entry, h):
        ran = self.run(scene, entry, h)
        out = {"scene": scene, "entry": entry.key, "h": h, "origin": self.origin(scene, entry),
               "most": self.most, **ran}
        if ran["end"] in ("done", "diverged", "late") and "mass" in ran:
            self.judge_again(out)
        return out

    def judge_again(self, result):
        """Of a run whose states are there: the judgement, and by which reference."""
        entry = next(e for e in (*plan.REFERENCES, *plan.ENTRIES) if e.key == result["entry"])
        reference = self.reference(result["scene"])
        result["reference"] = reference.key if reference else None
        result["judged"] = self.judge(result["scene"], entry, result["h"])
        return result


    def second(self, engine):
        """Where the thrown box ends by a program that has no line of the study, and how far that is from the study's run [m]."""
        if engine.endswith("_npm"):
            code = [str(HERE / f"second/{engine[:-4]}.mjs"), str((self.folder / "npm/node_modules").resolve())]
            command = ["node", *code] if self.program(engine) else None
        else:
            path = self.programs / f"rivals_second_{engine}"
            command = [str(path)] if path.exists() else None
        entry = next(e for e in plan.ENTRIES if e.engine == engine)
        states = self.states(plan.SECOND_SCENE, entry, plan.STEP)
        if not command or not states.exists():
            return None
        ended = json.loads(subprocess.run(command, capture_output=True, text=True).stdout.strip().splitlines()[-1])
        ran = array("d", states.read_bytes())[-13:]  # of the one body: position first
        return {"end": ended, "distance_m": math.dist(ended, ran[:3])}


def read(path):
    return [json.loads(line) for line in path.read_text().splitlines()] if path.exists() else []


def run_errors(study, quick, only, workers):
    path = study.folder / "results.jsonl"
    # What was late for a quicker study may end in this one.
    done = {(r["scene"], r["entry"], r["h"], r["origin"]) for r in read(path)
            if r["end"] != "late" or r.get("most", study.most) >= study.most}
    missing = sorted({e.engine for e in plan.ENTRIES if not study.program(e.engine)})
    if missing:
        print("not found, and left out:", ", ".join(missing), flush=True)
    todo = [r for r in plan.runs(quick) if study.program(r[1].engine) and re.search(only, f"{r[0]} {r[1].key}")
            and (r[0], r[1].key, r[2], study.origin(r[0], r[1])) not in done]
    print(f"{len(todo)} runs", flush=True)
    # References come first, for the judge compares with them.
    first = [r for r in todo if r[1].role == "reference"]
    with path.open("a") as file, ThreadPoolExecutor(workers) as pool:
        for part in (first, [r for r in todo if r[1].role != "reference"]):
            for run in as_completed([pool.submit(study.result, *r) for r in part]):
                file.write(json.dumps(run.result()) + "\n")
                file.flush()
        # A reference that came later, or of another program, judges the runs that were there.
        latest = {(r["scene"], r["entry"], r["h"]): r for r in read(path)}
        for r in latest.values():
            now = study.reference(r["scene"])
            if now and "judged" in r and (r.get("reference") != now.key or r["scene"] in {f[0] for f in first}):
                file.write(json.dumps(study.judge_again(r)) + "\n")


def is_idle(patience=180):
    """Whether the machine does little else, or comes to rest within that many seconds."""
    for _ in range(patience // 10):
        if os.getloadavg()[0] < 0.25 * os.cpu_count():
            return True
        time.sleep(10)
    return False


def run_times(study, only, rounds):
    """Rounds through all scenes and engines, so that a change of the machine's mood meets them all. Further sessions add to what
    there is."""
    session = 1 + max((r.get("session", 0) for r in times.read(study.folder)), default=0)
    with (study.folder / "times.jsonl").open("a") as file:
        for number in range(rounds):
            for scene in plan.TIMED + plan.SIZED:
                for entry in plan.ENTRIES:
                    if entry.engine.endswith("_npm") or not study.program(entry.engine) or not plan.takes_part(entry, scene) \
                            or not re.search(only, f"{scene} {entry.key}"):
                        continue
                    for h in plan.timed_steps(entry, scene):
                        ran = study.run(scene, entry, h, least=0.3, most=20.0)
                        if "us_a_step" in ran:
                            file.write(json.dumps({"scene": scene, "entry": entry.key, "h": h, "session": session, "round": number,
                                                   "end": ran["end"], "us_a_step": ran["us_a_step"],
                                                   "calibration_us": ran["calibration_us"], "load": os.getloadavg()[0]}) + "\n")
                            file.flush()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", default="", metavar="PATTERN", help="runs whose 'scene engine settings' match it")
    parser.add_argument("--times", type=int, metavar="ROUNDS",
                        help="of timed runs, on any machine; 5 on one that does little else, none with --quick")
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    study = Study(arguments.programs, arguments.folder, plan.MOST_QUICK if arguments.quick else plan.MOST)
    run_errors(study, arguments.quick, arguments.only, arguments.workers)
    second = {engine: study.second(engine) for engine in plan.SECOND}
    (arguments.folder / "second.json").write_text(json.dumps({e: s for e, s in second.items() if s}) + "\n")
    rounds = arguments.times
    if rounds is None and not arguments.quick:
        rounds = 5 if is_idle() else 0
        if not rounds:
            print("this machine does other things too: times are left out; --times 5 takes them all the same", flush=True)
    if rounds:
        run_times(study, arguments.only, rounds)


if __name__ == "__main__":
    main()
