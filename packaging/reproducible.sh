#!/usr/bin/env bash
# Builds the library in two folders of different names and lengths, without a cache of compiled files, and compares what is
# installed bit for bit.
#
#   reproducible.sh [JOBS]
set -euo pipefail

root=$(cd -- "$(dirname -- "$0")/.." && pwd)
jobs=${1:-$(nproc)}
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
export CCACHE_DISABLE=1
for place in one another/and-a-longer-one; do
  mkdir -p "$work/$place"
  git -C "$root" archive HEAD | tar -x -C "$work/$place"
  cmake -S "$work/$place" -B "$work/$place/build/library" -G Ninja -DCMAKE_BUILD_TYPE=Release -DPLUMB_LIBRARY_ONLY=ON \
    -DPLUMB_PYTHON=OFF -DCMAKE_INSTALL_PREFIX=/usr >"$work/log"
  cmake --build "$work/$place/build/library" -j "$jobs" >>"$work/log" || { tail -20 "$work/log" && exit 1; }
  DESTDIR=$work/$place/installed cmake --install "$work/$place/build/library" >>"$work/log"
done
diff -r "$work/one/installed" "$work/another/and-a-longer-one/installed"
(cd "$work/one/installed" && find . -type f -exec sha256sum {} + | sort -k 2 | grep -e '\.so' -e '\.a$')
echo "the same bits in two folders: $(find "$work/one/installed" -type f | wc -l) files"
