#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Drives live runs by their pages in Chromium.
#
#   run_live.sh SIMULATE_GDD ROOT FOLDER
#
# As run.sh does, outputs go to FOLDER, and exit code 77 says that there is no Chromium.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/begin.sh"
exec node "$here/live_test.mjs" "$folder" "$chromium" "$simulator" "$root/data"
