#!/usr/bin/env bash
# Runs a program of the bindings from the installed package alone, in an empty folder, and compares what it prints with
# what the command EXPECTED prints: the same program in C++, or the page that quotes it.
#
#   run_installed.sh LANGUAGE PREFIX EXAMPLE EXPECTED [ARGUMENTS...]
#
# PREFIX is the folder that was installed to; for Python, a build folder with the module, of which pip makes
# a wheel; for JavaScript, the folder of the package.
set -euo pipefail

language=$1 prefix=$2 example=$3
shift 3
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
cp "$example" "$work/"
cd "$work"
program=$(basename "$example")
if [[ $language == c-* ]]; then
  libraries=$(dirname "$(find "$prefix" -name 'libplumb.a')")
  export PKG_CONFIG_PATH="$libraries/pkgconfig"
fi

case $language in
  c-shared)
    read -ra flags <<<"$(pkg-config --cflags --libs plumb-c)"
    cc -std=c99 -pedantic -Wall -Wextra -Werror "$program" "${flags[@]}" -o drop
    LD_LIBRARY_PATH=$libraries ./drop >out
    ;;
  c-static)
    read -ra flags <<<"$(pkg-config --static --cflags --libs plumb-c)"
    cc -std=c99 -pedantic -Wall -Wextra -Werror "$program" "${flags[@]/#-lplumb/-l:libplumb.a}" -o drop
    ./drop >out
    ;;
  c-cmake)
    cat >CMakeLists.txt <<CMAKE
cmake_minimum_required(VERSION 3.25)
project(drop LANGUAGES C)
set(CMAKE_C_STANDARD 99)
find_package(plumb 0.1 REQUIRED COMPONENTS c)
add_executable(drop $program)
target_link_libraries(drop PRIVATE plumb::c)
add_executable(drop_static $program)
target_link_libraries(drop_static PRIVATE plumb::c_static)
CMAKE
    cmake -S . -B build -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_BUILD_TYPE=Release >/dev/null
    cmake --build build >/dev/null
    build/drop >out
    build/drop_static >out_static
    cmp out out_static
    ;;
  python | python-harness)
    checkout=$(cd -- "$(dirname -- "$example")/../../.." && pwd)
    # A copy of what pip needs: it writes beside the sources.
    mkdir checkout
    cp -r "$checkout/pyproject.toml" "$checkout/CMakeLists.txt" checkout/
    mkdir -p checkout/bindings
    cp -r "$checkout/bindings/python" checkout/bindings/
    settings=()
    if [[ $language == python-harness ]]; then settings=(--config-settings harness=yes); fi
    PLUMB_BUILD_DIR=$prefix /usr/bin/python3 -m pip install --quiet --no-index --no-deps --target site "${settings[@]}" ./checkout
    unset PLUMB_PROGRAM
    PYTHONPATH=$work/site /usr/bin/python3 "$program" >out
    ;;
  javascript)
    # What `npm pack` packs is what npm installs, without a network.
    tarball=$(npm pack --silent "$prefix")
    echo '{"private": true}' >package.json
    npm install --silent --offline --no-audit --no-fund "./$tarball"
    node "$program" >out
    ;;
  *)
    echo "unknown language $language"
    exit 2
    ;;
esac

"$@" >wanted
diff wanted out
cat out
