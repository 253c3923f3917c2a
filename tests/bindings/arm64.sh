#!/usr/bin/env bash
# Builds the library for 64-bit ARM, runs hashes.c on it under qemu, and compares what it prints with this machine's library.
#
#   arm64.sh PREFIX FOLDER     PREFIX: where this machine's is installed; FOLDER: of the build, which is kept
#
# Needs g++-aarch64-linux-gnu and qemu-user; without them the test is skipped.
set -euo pipefail

here=$(cd -- "$(dirname -- "$0")" && pwd)
root=$(cd -- "$here/../.." && pwd)
prefix=$1 folder=$2
for program in aarch64-linux-gnu-g++ aarch64-linux-gnu-gcc qemu-aarch64; do
  if ! command -v "$program" >/dev/null; then
    echo "skipped: $program is missing (packages g++-aarch64-linux-gnu, qemu-user)"
    exit 77
  fi
done
mkdir -p "$folder"
cmake -S "$root" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 \
  -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ -DPLUMB_LIBRARY_ONLY=ON -DPLUMB_PYTHON=OFF >"$folder/log"
cmake --build "$folder/build" --target plumb_c >>"$folder/log" || { tail -20 "$folder/log" && exit 1; }
library=$folder/build/bindings/c
aarch64-linux-gnu-gcc -std=c99 "$here/hashes.c" -I"$root/bindings/c/include" "$library/libplumb.so" -o "$folder/hashes"
qemu-aarch64 -L /usr/aarch64-linux-gnu -E LD_LIBRARY_PATH="$library" "$folder/hashes" >"$folder/printed"

libraries=$(dirname "$(find "$prefix" -name libplumb.a)")
cc -std=c99 "$here/hashes.c" -I"$prefix/include" "$libraries/libplumb.so" -o "$folder/hashes_here"
LD_LIBRARY_PATH=$libraries "$folder/hashes_here" >"$folder/wanted"
diff "$folder/wanted" "$folder/printed"
echo "the same $(wc -l <"$folder/wanted") hashes on aarch64 and $(uname -m)"
