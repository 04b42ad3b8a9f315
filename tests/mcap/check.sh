#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Reads MCAP logs with the format's own library and holds them against CSV logs of the same runs.
#
#   check.sh SIMULATE_GDD ROOT FOLDER
#
# Logs and libraries go to FOLDER. Exit code 77: skipped, for there is no node or no registry.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
simulator=$1 root=$2 folder=$3

skip() {
  printf 'skipped: %s\n' "$*"
  exit 77
}
command -v node >/dev/null || skip "node is not installed"
mkdir -p "$folder"
node "$here/../browser/npm_package.mjs" "$folder/node_modules" \
  @mcap/core 2.2.2 W4NFiyqQlJsNjw8JxAAQ872u0xLWJy0GFC3YFm8bTLbNs+HdDWe8DwBqznr0MGYpWtw+AX8XzHWB5Y9rLEGJJg== \
  @foxglove/schemas 2.1.0 Av19oG2AdRG5k/36iR/44bRrQB8fI7B5kad1gamXg9morMzklYlhl9+s578eXCR/V8RIeUo+zoUIf1UUt6gyZQ== \
  @foxglove/crc 0.0.3 DjIZsnL3CyP/yQ/vUYA9cjrD0a/8YXejI5ZmsaOiT16cLfZcTwaCxIN01/ys4jsy+dZCQ/9DnWFn7AEFbiMDaA== \
  heap-js 2.7.1 EQfezRg0NCZGNlhlDR3Evrw1FVL2G3LhU7EgPoxufQKruNBSYA8MiRPHeWbU+36o+Fhel0wMwM+sLEiBAlNLJA== \
  tslib 2.8.1 oJFu94HQb+KVduSUQL7wnpmqnfmLsOA/nAh6b6EH0wCEoK0/mPeXU6c3wKDV83MkOuHPRHtSXKKU99IBazS/2w== ||
  skip "the libraries cannot be had"

log() {  # NAME MODEL ARGUMENTS…
  for kind in csv mcap; do
    "$simulator" "${@:2}" --log "$folder/$1.$kind" --quiet
  done
}
humanoid=$root/data/robots/humanoid.urdf arm=$root/data/robots/arm.urdf
log humanoid "$humanoid" --goals "$root/data/goals/stand_and_reach.yaml" --duration 1
log arm "$arm" --reach hand=0.5,0.3,0.5 --duration 0.5 --log-every 7
# A run that is broken, and goes on.
rm -f "$folder/checkpoint"
reach=("$arm" --reach hand=0.5,0.3,0.5 --checkpoint "$folder/checkpoint" --checkpoint-every 0.05 --log-every 7)
"$simulator" "${reach[@]}" --duration 0.22 --log "$folder/resumed.mcap" --quiet
"$simulator" "${reach[@]}" --duration 0.5 --log "$folder/resumed.mcap" --resume "$folder/checkpoint" --quiet
cp "$folder/arm.csv" "$folder/resumed.csv"
exec node "$here/check.mjs" "$folder" humanoid="$humanoid" arm="$arm" resumed="$arm"
