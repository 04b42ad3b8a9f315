#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Looks at replay pages of special runs in Chromium: one beside another, with images on surfaces, with
# goals that come and go, with long names.
#
#   run_views.sh SIMULATE_GDD ROOT FOLDER
#
# As run.sh does, outputs go to FOLDER, and exit code 77 says that there is no Chromium.
set -euo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/begin.sh"
exec node "$here/views_test.mjs" "$folder" "$chromium" "$simulator" "$root/data"
