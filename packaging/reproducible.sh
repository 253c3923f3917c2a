#!/usr/bin/env bash
# Builds the library in two folders of different names and lengths, without a cache of compiled files, and compares what is
# installed bit for bit. With sources, only these are compiled, and their object files compared.
#
#   reproducible.sh [engine/.../FILE.cpp...]
set -euo pipefail

root=$(cd -- "$(dirname -- "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
export CCACHE_DISABLE=1
mkdir "$work/packed"
git -C "$root" archive HEAD | tar -x -C "$work/packed"
objects=()
for source in "$@"; do objects+=("engine/CMakeFiles/plumb_engine.dir/${source#engine/}.o"); done
for place in one another/and-a-longer-one; do
  mkdir -p "$(dirname "$work/$place")" "$work/$place-kept"
  cp -r "$work/packed" "$work/$place"
  build=$work/$place/build/library
  cmake -S "$work/$place" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPLUMB_LIBRARY_ONLY=ON -DPLUMB_PYTHON=OFF \
    -DPLUMB_UNITY=$(($# == 0)) -DCMAKE_INSTALL_PREFIX=/usr >"$work/log"
  ninja -C "$build" "${objects[@]}" >>"$work/log" || { tail -20 "$work/log" && exit 1; }
  if (($# == 0)); then
    DESTDIR=$work/$place-kept cmake --install "$build" >>"$work/log"
  else
    (cd "$build" && cp --parents "${objects[@]}" "$work/$place-kept")
  fi
done
diff -r "$work/one-kept" "$work/another/and-a-longer-one-kept"
echo "the same bits in two folders: $(find "$work/one-kept" -type f | wc -l) files"
