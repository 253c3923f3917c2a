#!/usr/bin/env bash
# Compiles and runs the consumer with what pkg-config says about an installed plumb, and compiles each header alone.
#
#   pkg_config.sh PREFIX OUTPUT COMPILER [FLAGS...]
set -euo pipefail

here=$(dirname -- "$(readlink -f -- "$0")")
prefix=$1 output=$2 compiler=$3
shift 3

PKG_CONFIG_PATH=$(find "$prefix" -name pkgconfig -type d)
export PKG_CONFIG_PATH
read -ra flags <<<"$(pkg-config --cflags --libs plumb)"
"$compiler" -std=c++20 -DFORMER_HEADERS "$@" "$here/consumer/fall.cpp" "${flags[@]}" -o "$output"
"$output"

# Programs from before 0.2 include "engine/...", internal headers among them, also beside <plumb/...>.
printf '#include "engine/%s.h"\n' world/world world/snapshot_check scene/error world/checksum |
  sed '1i #include <plumb/queries.h>' | "$compiler" -std=c++20 -fsyntax-only -x c++ - "${flags[@]/#-l*/}"

# Public headers are few, and each includes what it needs; strictly by the standard, so that other compilers read them.
headers=("$prefix"/include/plumb/*.h)
((${#headers[@]} >= 9 && ${#headers[@]} <= 16)) || { echo "${#headers[@]} headers are public" && exit 1; }
for header in "${headers[@]}"; do
  echo "#include <plumb/$(basename "$header")>" |
    "$compiler" -std=c++20 -pedantic-errors -Wall -Wextra -Werror -fsyntax-only -x c++ - "${flags[@]/#-l*/}"
done
echo "${#headers[@]} headers compile alone"
