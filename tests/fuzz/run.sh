#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# run.sh BUILD SECONDS [NAME…]: runs the fuzz programs of a build tree, all or by name, each for so
# long, as many at a time as there are cores. What they keep as new starts, and findings, go to
# BUILD/fuzz/<name>. Prints how often each was executed; ends with 1 where there is a finding.
set -euo pipefail
build=$1 seconds=$2
shift 2
tree=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
names=("$@")
((${#names[@]})) || names=(urdf mjcf scene goals table mesh checkpoint live step)

# seeds NAME: folders of inputs to begin with.
seeds() {
  case "$1" in
    urdf) echo data/robots tests/bad_input/files/model tests/bad_input/files data/scenes/stability ;;
    mjcf) echo tests/mjcf/files tests/bad_input/files/mjcf ;;
    scene) echo data/scenes tests/bad_input/files/scene ;;
    goals) echo data/goals tests/bad_input/files/goals ;;
    table) echo tests/fuzz/seeds/table tests/bad_input/files/table tests/bad_input/files/heights ;;
    mesh) echo tests/fuzz/seeds/mesh tests/cases/meshes tests/cases/open_mesh ;;
    live) echo tests/fuzz/seeds/live data/events ;;
  esac
}

# settings NAME: its longest input [bytes], and words that it is made of.
settings() {
  case "$1" in
    urdf) echo -max_len=8192 -dict=tests/fuzz/urdf.dict ;;
    mjcf) echo -max_len=8192 -dict=tests/fuzz/mjcf.dict ;;
    scene | goals) echo -max_len=4096 -dict=tests/fuzz/yaml.dict ;;
    live) echo -max_len=4200 -dict=tests/fuzz/yaml.dict ;;
    table | mesh) echo -max_len=4096 "-dict=tests/fuzz/$1.dict" ;;
    checkpoint) echo -max_len=256 -timeout=60 ;;  # steps too
    # Sanitizers make steps some sixty times as slow: what takes 1 s is given a minute.
    step) echo -max_len=512 -len_control=0 -timeout=60 ;;
  esac
}

# A finding is: any exception but a refusal, what a sanitizer reports, 10 s, 1 GB.
fuzz() {
  local name=$1 folder=$build/fuzz/$1 code=0
  mkdir -p "$folder/starts"
  local leaks=1
  [[ $name != mesh ]] || leaks=0  # assimp loses some bytes of an STL that it refuses
  # shellcheck disable=SC2046
  ASAN_OPTIONS=$ASAN_OPTIONS:detect_leaks=$leaks "$build/tests/fuzz/fuzz_$name" -timeout=10 -max_total_time="$seconds" \
    -rss_limit_mb=1024 $(settings "$name") -print_final_stats=1 -verbosity=0 -artifact_prefix="$folder/" \
    "$folder/starts" $(seeds "$name") >"$folder/log" 2>&1 || code=$?
  printf '%-10s %9s executions, %s\n' "$name" \
    "$(awk '/number_of_executed_units/ { print $2 }' "$folder/log")" \
    "$( ((code == 0)) && echo 'no finding' || echo "FINDING, $folder/log")"
  return "$code"
}

cd "$tree"
build=$(realpath "$build")
export ASAN_OPTIONS=quarantine_size_mb=32:allocator_may_return_null=1
failed=0 running=0
for name in "${names[@]}"; do
  if ((running == $(nproc))); then
    wait -n || failed=1
    running=$((running - 1))
  fi
  fuzz "$name" &
  running=$((running + 1))
done
while ((running > 0)); do
  wait -n || failed=1
  running=$((running - 1))
done
exit "$failed"
