#!/usr/bin/env bash
# Packs the components, and compiles and runs the C page's program with what two of the tarballs hold, wherever they are unpacked.
#
#   tarballs.sh BUILD_FOLDER EXAMPLE
set -euo pipefail

build=$1 example=$2
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
cpack -G TGZ --config "$build/CPackConfig.cmake" -B "$work/packed" >"$work/log" || { cat "$work/log" && exit 1; }
mkdir "$work/here"
for component in runtime c; do
  tar -xzf "$work"/packed/plumb-*-"$component".tar.gz -C "$work/here" --strip-components 1
done
libraries=$(dirname "$(find "$work/here" -name 'libplumb.a')")
export PKG_CONFIG_PATH=$libraries/pkgconfig
read -ra flags <<<"$(pkg-config --cflags --libs plumb-c)"
cc -std=c99 "$example" "${flags[@]}" -o "$work/ball"
LD_LIBRARY_PATH=$libraries "$work/ball" | tail -1 | grep -q '^2.00 s: 1.61 m$'
for component in runtime c cpp harness; do compgen -G "$work/packed/plumb-*-$component.tar.gz" >"$work/log"; done
echo "four tarballs"
