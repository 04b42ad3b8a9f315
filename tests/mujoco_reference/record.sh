#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs record.mjs with MuJoCo from npm, in the version and with the checksum of package-lock.json.
#
#   record.sh MODULES REFERENCE [--check] [NAME…]
#   record.sh MODULES FOLDER --stability    stability.mjs in FOLDER
#
# MODULES is a folder of the build tree, into which npm installs; nothing is fetched when it is
# there already. Exit code 77: skipped, for MuJoCo cannot be had here.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
modules=$1 reference=$2
shift 2

skip() {
  printf 'skipped: %s\n' "$*"
  exit 77
}
command -v node >/dev/null && command -v npm >/dev/null || skip "node and npm are not installed"

mkdir -p "$modules"
if ! cmp -s "$here/package-lock.json" "$modules/installed-lock.json"; then
  cp "$here/package.json" "$here/package-lock.json" "$modules"
  (cd "$modules" && npm ci --ignore-scripts --no-audit --no-fund >npm.log 2>&1) ||
    skip "npm cannot install MuJoCo; $modules/npm.log says why"
  cp "$here/package-lock.json" "$modules/installed-lock.json"
fi
[[ ${1:-} == --stability ]] && exec node "$here/stability.mjs" "$modules/node_modules" "$reference"
exec node "$here/record.mjs" "$modules/node_modules" "$reference" "$@"
