# SPDX-License-Identifier: GPL-3.0-or-later
# Completion for bash (for zsh: bashcompinit): commands and options as the program itself lists them.
_watertight() {
  local word=${COMP_WORDS[COMP_CWORD]} program=${COMP_WORDS[0]} names
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    names=$("$program" --help 2>/dev/null | sed -n '/^Subcommands:/,$s/^  \([a-z][a-z-]*\).*/\1/p')
  elif [[ $word == -* ]]; then
    names=$("$program" "${COMP_WORDS[1]}" --help 2>/dev/null | grep -oE -- '--[a-z][a-z-]*' | sort -u)
  else
    return # files
  fi
  mapfile -t COMPREPLY < <(compgen -W "$names" -- "$word")
}
complete -o default -F _watertight watertight
