#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What bash offers for the arguments of simulate_gdd.
#   completion_test.sh SIMULATE_GDD SOURCE_FOLDER
set -euo pipefail
program=$1 failed=0
cd "$2"
source apps/simulate_gdd/completion.bash

# offers EXPECTED WORD…: all that is offered for the last word, in one line.
offers() {
  local expected=$1
  COMP_WORDS=("$program" "${@:2}")
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
  _simulate_gdd || true
  [[ "${COMPREPLY[*]}" == $expected ]] && return
  printf 'after %s\n  found    %s\n  expected %s\n' "${*:2}" "${COMPREPLY[*]}" "$expected" >&2
  failed=1
}

arm=data/robots/arm.urdf
links=$(grep -c '<link ' $arm)
offers 'right_hand=' data/robots/humanoid.urdf --reach right_ha
offers 'right_hand=' data/robots/humanoid.urdf --reach = right_ha
offers 'right_hand' data/robots/humanoid.urdf --hold right_ha
offers 'right_elbow=' data/robots/humanoid.urdf --q0 right_el
offers 'left_knee=0.5,right_elbow=' data/robots/humanoid.urdf --q0 left_knee=0.5,right_el
offers '' data/robots/humanoid.urdf --reach no_such_link
offers 'fixed floating*' $arm --base ''
offers 'floating' $arm --base flo
offers '--duration' $arm --dur
offers '--goals' --goa
offers 'data/goals/stand_and_reach.yaml' data/robots/humanoid.urdf --goals data/goals/stand_and
offers 'data/robots/arm.urdf' data/robots/arm.u
COMP_WORDS=("$program" $arm --reach '') COMP_CWORD=3
_simulate_gdd || true
((${#COMPREPLY[@]} == links)) || { echo "found ${#COMPREPLY[@]} links, expected $links" >&2; failed=1; }
exit $failed
