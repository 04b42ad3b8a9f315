#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the replay page from the sources in this folder, with the libraries of package-lock.json.
#
#   build.sh MODULES PAGE [--check]
#
# MODULES is a folder of the build tree, into which npm installs; nothing is fetched when it is
# there already. With --check the page is made beside it and compared with PAGE. Exit code 77:
# skipped, for the libraries cannot be had here.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
modules=$1 page=$2

skip() {
  printf 'skipped: %s\n' "$*"
  exit 77
}
command -v node >/dev/null && command -v npm >/dev/null || skip "node and npm are not installed"

mkdir -p "$modules"
if ! cmp -s "$here/package-lock.json" "$modules/installed-lock.json"; then
  cp "$here/package.json" "$here/package-lock.json" "$modules"
  (cd "$modules" && npm ci --ignore-scripts --no-audit --no-fund >npm.log 2>&1) ||
    skip "npm cannot install the libraries; $modules/npm.log says why"
  cp "$here/package-lock.json" "$modules/installed-lock.json"
fi

if [[ ${3:-} != --check ]]; then
  exec node "$here/build.mjs" "$modules/node_modules" "$page"
fi
node "$here/build.mjs" "$modules/node_modules" "$modules/replay_page.html"
cmp "$modules/replay_page.html" "$page" || {
  printf '%s is not what its sources give; "./dev page" makes it anew\n' "$page" >&2
  exit 1
}
