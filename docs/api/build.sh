#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# build.sh FOLDER: the API reference of the public headers, made anew in FOLDER; a warning of Doxygen
# fails. Exit code 77: there is no Doxygen.
set -euo pipefail
api=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$api/../.." && pwd)
command -v doxygen >/dev/null || { echo "doxygen was not found" >&2; exit 77; }

rm -rf "$1"
mkdir -p "$1/include/softgauss"
output=$(cd "$1" && pwd)
# The headers by the names by which they are included.
for library in engine gdd collision io; do
  ln -s "$root/$library" "$output/include/softgauss/$library"
done
version=$(sed -n 's/^project(softgauss VERSION \([0-9.]*\).*/\1/p' "$root/CMakeLists.txt")
sed "s|@version@|$version|g; s|@output@|$output|g; s|@include@|$output/include|g; s|@api@|$api|g" \
  "$api/Doxyfile.in" >"$output/Doxyfile"

if ! doxygen "$output/Doxyfile"; then
  sed "s|$output/include/softgauss/||" "$output/warnings.txt" | sort -u >&2
  exit 1
fi
