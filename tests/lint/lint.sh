#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# lint.sh BUILD: cppcheck over the sources, then clang-tidy over those that BUILD has compiled, as it
# has compiled them: several files at once, so that it takes minutes. Ends with 1 where one of them
# finds something. What is left alone has its reason in cppcheck.txt and in .clang-tidy.
set -euo pipefail
build=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
failed=0
cppcheck --std=c++20 --language=c++ --enable=warning,performance,portability --quiet -j "$(nproc)" \
  --error-exitcode=1 --suppressions-list=tests/lint/cppcheck.txt -I "$build/include" \
  engine gdd collision io apps || failed=1
find "$build" -path '*/tests/*' -prune -o -path '*/Unity/*.cxx' -print0 | sort -z |
  xargs -0 -n1 -P "$(nproc)" clang-tidy -p "$build" --config-file=.clang-tidy --quiet \
    --extra-arg=-Wno-unknown-warning-option 2>/dev/null || failed=1
exit "$failed"
