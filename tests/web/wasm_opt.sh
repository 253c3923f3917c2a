#!/usr/bin/env bash
# Links a program with the toolchain for WebAssembly while a `wasm-opt` that refuses everything is on the search path: clang runs
# the one that it finds, and Debian's refuses SIMD.
#
#   wasm_opt.sh TOOLCHAIN
set -euo pipefail

toolchain=$1
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
mkdir "$work/bin"
printf '#!/bin/sh\necho "wasm-opt was called: $*"\nexit 1\n' >"$work/bin/wasm-opt"
chmod +x "$work/bin/wasm-opt"
export PATH=$work/bin:$PATH

printf 'extern "C" __attribute__((export_name("two"))) int two() { return 2; }\n' >"$work/two.cpp"
cat >"$work/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(two LANGUAGES CXX)
add_executable(two two.cpp)
CMAKE
cmake -S "$work" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release --toolchain "$toolchain" >"$work/log"
cmake --build "$work/build" >>"$work/log" || { cat "$work/log" && exit 1; }
test -s "$work/build/two"
echo "linked without wasm-opt"
