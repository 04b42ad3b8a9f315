#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The moving pictures of README, from pages of real runs; needs img2webp.
#
#   moving.sh SIMULATE_GDD ROOT FOLDER PICTURES
#
# Runs and single pictures go to FOLDER, NAME.webp to PICTURES. Exit code 77: there is no Chromium.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/begin.sh"
pictures=$4 rate=15
record() {  # NAME ARGUMENTS…
  "$simulator" "${@:2}" --view "$folder/$1.html" --quiet
}
record humanoid_dragged "$root/data/robots/humanoid.urdf" --play "$root/data/events/humanoid_dragged.yaml"
record arm_picks "$root/data/scenes/arm_picks.yaml" --duration 8
for name in humanoid_dragged arm_picks; do
  rm -rf "$folder/moving/$name"
  mkdir -p "$folder/moving/$name"
  node "$here/moving.mjs" "$folder" "$chromium" "$name" "$rate" "$folder/moving/$name"
  img2webp -loop 0 -lossy -q 60 -m 6 -d $((1000 / rate)) "$folder/moving/$name"/*.png -o "$pictures/$name.webp"
done
