#!/usr/bin/env bash
# Compiles and runs the consumer with what pkg-config says about an installed plumb.
#
#   pkg_config.sh PREFIX OUTPUT COMPILER [FLAGS...]
set -euo pipefail

here=$(dirname -- "$(readlink -f -- "$0")")
prefix=$1 output=$2 compiler=$3
shift 3

PKG_CONFIG_PATH=$(find "$prefix" -name pkgconfig -type d)
export PKG_CONFIG_PATH
read -ra flags <<<"$(pkg-config --cflags --libs plumb)"
"$compiler" -std=c++20 "$@" "$here/consumer/fall.cpp" "${flags[@]}" -o "$output"
"$output"
