#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What the browser test needs: node, Chromium and playwright-core, which drives it.
#
#   install.sh FOLDER
#
# FOLDER is in the build tree; playwright-core comes to FOLDER/playwright-core. node and Chromium are
# Debian's; they are installed where they are missing and this user may do so. On success the last
# line is Chromium's path. Exit code 77: one of them cannot be had here.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
folder=$1
mkdir -p "$folder"

skip() {
  printf 'skipped: %s\n' "$*"
  exit 77
}

browser() { command -v chromium || command -v chromium-browser || command -v google-chrome; }

missing=()
command -v node >/dev/null || missing+=(nodejs)
browser >/dev/null || missing+=(chromium)
if ((${#missing[@]})); then
  command -v apt-get >/dev/null || skip "these are not installed: ${missing[*]}"
  root=()
  ((EUID == 0)) || root=(sudo -n)
  { "${root[@]}" apt-get update && "${root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "${missing[@]}"; } >"$folder/apt.log" 2>&1 ||
    skip "apt-get cannot install ${missing[*]}; $folder/apt.log says why"
fi
node "$here/npm_package.mjs" "$folder" playwright-core 1.57.0 \
  agTcKlMw/mjBWOnD6kFZttAAGHgi/Nw0CZ2o6JqWSbMlI219lAFLZZCyqByTsvVAJq5XA5H8cA6PrvBRpBWEuQ== ||
  skip "playwright-core cannot be had"
browser
