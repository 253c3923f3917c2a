#!/usr/bin/env bash
# Checks that every source is laid out as .clang-format says. `format.sh --fix` lays them out.
# Other versions of clang-format differ in details, so only 14 decides: without it the check is skipped (status
# 77), in CI it fails.
set -euo pipefail

cd -- "$(dirname -- "$(readlink -f -- "$0")")/../.."

formatter=""
for candidate in clang-format-14 clang-format; do
  if command -v "$candidate" >/dev/null && "$candidate" --version | grep -q 'version 14\.'; then
    formatter=$candidate
    break
  fi
done
if [[ -z $formatter ]]; then
  echo "clang-format 14 is not installed (apt-get install clang-format-14)"
  if [[ -n ${CI:-} ]]; then exit 1; fi
  exit 77
fi

mapfile -d '' files < <(find engine reference scenarios harness extremes app bench bindings demos tests \
  \( -name '*.h' -o -name '*.cpp' \) -type f -print0 2>/dev/null | sort -z)
if ((${#files[@]} == 0)); then
  echo "no sources were found"
  exit 1
fi
if [[ ${1:-} == --fix ]]; then
  "$formatter" -i "${files[@]}"
else
  "$formatter" --dry-run --Werror "${files[@]}"
fi
echo "${#files[@]} files"
