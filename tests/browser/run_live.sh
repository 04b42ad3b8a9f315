#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Drives live runs by their pages in Chromium.
#
#   run_live.sh SIMULATE_GDD ROOT FOLDER
#
# As run.sh does, outputs go to FOLDER, and exit code 77 says that there is no Chromium.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
simulator=$1 root=$2 folder=$3

if ! said=$("$here/install.sh" "$folder"); then
  printf '%s\n' "$said"
  exit 77
fi
exec node "$here/live_test.mjs" "$folder" "$(tail -n 1 <<<"$said")" "$simulator" "$root/data"
