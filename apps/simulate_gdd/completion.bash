# SPDX-License-Identifier: Apache-2.0
# Completes the arguments of simulate_gdd in bash: options, their choices, files, and the links and
# joints of the URDF on the line. Installed where bash-completion finds it; else: source this file.

# Names of links or of joints in the URDF files on the line.
_simulate_gdd_names() {  # link | joint
  local word
  for word in "${COMP_WORDS[@]}"; do
    word=${word/#\~/$HOME}
    [[ $word == *.urdf && -f $word ]] || continue
    tr '\n' ' ' <"$word" | sed 's/<!--[^>]*-->//g' | grep -oE "<$1[[:space:]][^>]*" |
      sed -nE "s/.*[[:space:]]name[[:space:]]*=[[:space:]]*[\"']([^\"']*)[\"'].*/\1/p"
  done
}

# The option before the word: --reach of `--reach ha` and of `--reach=ha`, which bash splits at =.
_simulate_gdd_option() {
  local i=$((COMP_CWORD - 1))
  [[ ${COMP_WORDS[COMP_CWORD]} == '=' || ${COMP_WORDS[i]} != '=' ]] || ((--i))
  printf '%s' "${COMP_WORDS[i]}"
}

_simulate_gdd() {
  local word=${COMP_WORDS[COMP_CWORD]} option help choices before
  [[ $word != '=' ]] || word=
  option=$(_simulate_gdd_option)
  COMPREPLY=()

  case $option in
    --reach | --hold)
      mapfile -t COMPREPLY < <(compgen -W "$(_simulate_gdd_names link)" -- "$word")
      if [[ $option == --reach ]]; then  # LINK=x,y,z
        COMPREPLY=("${COMPREPLY[@]/%/=}")
        compopt -o nospace 2>/dev/null
      fi
      return ;;
    --q0)  # JOINT=q,JOINT=q: the last of a list
      before=
      [[ $word != *,* ]] || before=${word%,*},
      mapfile -t COMPREPLY < <(compgen -P "$before" -S = -W "$(_simulate_gdd_names joint)" -- "${word##*,}")
      compopt -o nospace 2>/dev/null
      return ;;
    --goals | --play)
      mapfile -t COMPREPLY < <(compgen -f -X '!*.yaml' -- "$word"; compgen -d -- "$word")
      compopt -o filenames 2>/dev/null
      return ;;
    --torques)
      mapfile -t COMPREPLY < <(compgen -f -X '!*.csv' -- "$word"; compgen -d -- "$word")
      compopt -o filenames 2>/dev/null
      return ;;
  esac

  help=$("${COMP_WORDS[0]/#\~/$HOME}" --help-all 2>/dev/null)
  if [[ $option == --* ]]; then
    # Of "  --base TEXT:{fixed,floating}  …" the choices; nothing of an option without a value.
    choices=$(sed -nE "s/^  (-[a-z],)?$option( [^{ ]*:)\{([^}]*)\}.*/\3/p" <<<"$help" | tr ',' ' ')
    if [[ -n $choices ]]; then
      mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word")
      return
    fi
    if grep -qE "^  (-[a-z],)?$option [A-Z:]" <<<"$help" && [[ $word != -* ]]; then
      compopt -o default 2>/dev/null  # a number, or a file
      return
    fi
  fi
  if [[ $word == -* ]]; then
    choices=$(sed -nE 's/^  (-[a-z],)?(--[a-z0-9-]+).*/\2/p' <<<"$help")
    mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$word")
    return
  fi
  mapfile -t COMPREPLY < <(compgen -f -X '!*.urdf' -- "$word"; compgen -f -X '!*.yaml' -- "$word"
    compgen -d -- "$word")
  compopt -o filenames 2>/dev/null
}

complete -F _simulate_gdd simulate_gdd
