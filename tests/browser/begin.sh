# SPDX-License-Identifier: Apache-2.0
# Sourced by what drives pages in Chromium, with SIMULATE_GDD ROOT FOLDER: sets here, simulator, root,
# folder and chromium. Ends it with exit code 77 where there is no Chromium.
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
simulator=$1 root=$2 folder=$3

if ! said=$("$here/install.sh" "$folder"); then
  printf '%s\n' "$said"
  exit 77
fi
chromium=$(tail -n 1 <<<"$said")
