#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Records runs and looks at their replay pages in Chromium.
#
#   run.sh SIMULATE_GDD ROOT FOLDER [SCRIPT ARGUMENT…]
#
# Runs, screenshots and playwright-core go to FOLDER. Exit code 77: skipped, for there is no Chromium.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/begin.sh"
record() {  # NAME ARGUMENTS…
  "$simulator" "${@:2}" --view "$folder/$1.html" --log "$folder/$1.csv" --quiet
}
record humanoid "$root/data/robots/humanoid.urdf" --goals "$root/data/goals/stand_and_reach.yaml" --duration 10
record arm "$root/data/robots/arm.urdf" --goals "$root/data/goals/arm_reach.yaml" --duration 2
record hand "$root/data/robots/hand.urdf" --passive --duration 1
# Beyond 20,000 steps: thinned. The torques overflow within a step: exit code 3.
record long "$root/data/robots/arm.urdf" --passive --timestep 5e-5 --duration 1.1
printf 'time_s,u:shoulder_yaw,u:elbow_pitch\n0,0,0\n0.098,1e12,-1e12\n' >"$folder/torques.csv"
code=0
record failed "$root/data/robots/arm.urdf" --torques "$folder/torques.csv" --integrator runge-kutta-4 --duration 1 2>"$folder/failed.txt" || code=$?
((code == 3)) || { printf "the run that shall fail ended with code %s\n" "$code" >&2; exit 1; }
script=${4:-replay_test.mjs}
arguments=("${@:5}")
((${#arguments[@]})) || arguments=("$root/data/robots")
exec node "$here/$script" "$folder" "$chromium" "${arguments[@]}"
