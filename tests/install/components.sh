#!/usr/bin/env bash
# Installs each component alone, and checks what it brings and what it leaves out.
#
#   components.sh BUILD_FOLDER
set -euo pipefail

build=$1
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT

# has COMPONENT PATTERN...: each pattern matches a file that the component installs; with ! none does.
has() {
  local component=$1 pattern files
  shift
  cmake --install "$build" --prefix "$work/$component" --component "$component" >"$work/log"
  files=$(cd "$work/$component" && find . \( -type f -o -type l \) | sort)
  for pattern in "$@"; do
    if [[ $pattern == !* ]]; then
      if grep -q -- "${pattern#!}" <<<"$files"; then
        printf '%s has %s:\n%s\n' "$component" "${pattern#!}" "$files" && exit 1
      fi
    elif ! grep -q -- "$pattern" <<<"$files"; then
      printf '%s lacks %s:\n%s\n' "$component" "$pattern" "$files" && exit 1
    fi
  done
}

has runtime 'libplumb\.so\.[0-9]*\.[0-9]*$' '!\.h$' '!\.a$' '!\.pc$' '!\.cmake$'
has c '/libplumb\.a$' '/libplumb\.so$' '/plumb/plumb\.h$' '/plumb-c\.pc$' '!/world\.h$' '!libplumb_engine'
has cpp 'libplumb_engine\.' '/plumb/world\.h$' '/plumb/detail/' '/plumb\.pc$' '!/plumb/plumb\.h$' '!/detail/.*world_data\.h$' '/compat/engine/world/world\.h$'
has harness '/bin/plumb$' '/plumbScenarios\.cmake$' '/compat/scenarios/scenario\.h$' '/compat/scenarios/truth/parts\.h$' '!\.a$'
