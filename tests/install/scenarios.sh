#!/usr/bin/env bash
# Builds scenarios out of the tree, from an installed prefix alone in an empty folder, with ctest entries of their own: the
# one that docs/adding-a-scenario.md shows passes, the same with a wrong sign in its truth fails.
#
#   scenarios.sh BUILD_FOLDER DOC_EXAMPLE [CMAKE_OPTIONS...]
set -euo pipefail

build=$1 example=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" --component harness >/dev/null
mkdir "$work/mine"
cd "$work/mine"
cp "$example" dumbbell.cpp
sed 's/t \* t \/ 2 \* kGravity/t * t * kGravity/; s/"dumbbell"/"wrong"/' dumbbell.cpp >wrong.cpp
cat >CMakeLists.txt <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(mine LANGUAGES CXX)
enable_testing()
find_package(plumb 0.1 REQUIRED COMPONENTS harness)
plumb_add_scenarios(mine dumbbell.cpp)
plumb_add_scenarios(faulty wrong.cpp ENGINES plumb-precise LABEL planted)
CMAKE
cmake -S . -B build -DCMAKE_PREFIX_PATH="$work/prefix" "$@" >/dev/null
cmake --build build >log 2>&1 || { cat log && exit 1; }

# ran PATTERN EXIT_CODE: the tests that match are there, and end so.
ran() {
  local code=0
  ctest --test-dir build -R "$1" --no-tests=error --output-on-failure >out || code=$?
  if ((code != $2)); then cat out && echo "ctest -R $1 ended with $code" && exit 1; fi
}
ran '^mine/dumbbell$' 0
ran '^faulty/wrong$' 8
grep -q 'position_error' out || { cat out && exit 1; }
ctest --test-dir build -N >out
grep -q 'Total Tests: 2' out || { cat out && exit 1; }
ctest --test-dir build -N -L planted >out
grep -q 'Total Tests: 1' out || { cat out && exit 1; }

# Engines from npm can be installed with it.
"$work/prefix/bin/plumb" engines >out
grep -q '^rapier ' out || { cat out && exit 1; }

# The program by itself knows nothing of them, takes several modules, and refuses what is none.
program=$work/prefix/bin/plumb
"$program" list >out
if grep -q '^dumbbell$' out; then echo "dumbbell is there without its module" && exit 1; fi
PLUMB_SCENARIOS=build/libmine.so:build/libfaulty.so "$program" list >out
if ! grep -q '^dumbbell$' out || ! grep -q '^wrong$' out; then cat out && exit 1; fi
code=0
PLUMB_SCENARIOS=absent.so "$program" list 2>err || code=$?
if ((code != 2)) || ! grep -q 'absent.so' err; then cat err && exit 1; fi
echo 'int x;' >other.cpp
"${CXX:-c++}" -shared -fPIC other.cpp -o other.so
code=0
PLUMB_SCENARIOS=other.so "$program" list 2>err || code=$?
if ((code != 2)) || ! grep -q 'plumb_add_scenarios' err; then cat err && exit 1; fi
echo "2 tests out of the tree"
