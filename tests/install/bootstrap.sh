#!/usr/bin/env bash
# The script `plumb` at work on a project of one file: what it prints where, what it builds when, and what it
# leaves behind when it is interrupted. Nothing is installed: where packages are missing, apt-get is a fake.
#
#   bootstrap.sh CHECKOUT
set -euo pipefail

checkout=$(readlink -f -- "$1")
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
failures=0

check() {
  local what=$1
  shift
  if "$@"; then
    printf 'ok      %s\n' "$what"
  else
    printf 'FAILED  %s: %s\n' "$what" "$*"
    failures=$((failures + 1))
  fi
}
same() { [[ $1 == "$2" ]] || { printf 'got      |%s|\nexpected |%s|\n' "$1" "$2" && false; }; }
has() { [[ $(<"$1") == *"$2"* ]] || { sed 's/^/  | /' "$1" && false; }; }
lacks() { [[ $(<"$1") != *"$2"* ]] || { sed 's/^/  | /' "$1" && false; }; }
empty() { [[ ! -s $1 ]] || { sed 's/^/  | /' "$1" && false; }; }

# run NAME COMMAND...: sets status, and $work/NAME.out and .err.
run() {
  local name=$1
  shift
  status=0
  "$@" >"$work/$name.out" 2>"$work/$name.err" </dev/null || status=$?
}

# A project with the targets that the script builds; its program answers with its arguments and a status.
tree="$work/a tree"
mkdir -p "$tree"
cp "$checkout/plumb" "$checkout/CMakePresets.json" "$tree/"
cat >"$tree/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(plumb VERSION 0.1.0 LANGUAGES CXX)
option(PLUMB_TESTS "" ON)
option(PLUMB_BENCHES "" ON)
option(PLUMB_WINDOW "" ON)
option(PLUMB_WEB "" OFF)
add_executable(plumb_app main.cpp)
set_target_properties(plumb_app PROPERTIES OUTPUT_NAME plumb RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
add_custom_target(programs DEPENDS plumb_app)
if(PLUMB_TESTS)
  enable_testing()
  add_test(NAME passes COMMAND plumb_app status 0)
  add_test(NAME fails COMMAND plumb_app status 1)
endif()
CMAKE
program() {
  cat >"$tree/main.cpp" <<CPP
#include <cstdlib>
#include <cstdio>
#include <cstring>
int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) std::printf("[%s]", argv[i]);
  std::printf(" $1\n");
  return argc == 3 && std::strcmp(argv[1], "status") == 0 ? std::atoi(argv[2]) : 0;
}
CPP
}
program one

# Commands of the system that say that nothing, or everything, is installed.
fake="$work/fake"
mkdir -p "$fake"
fake() {
  cat >"$fake/$1"
  chmod +x "$fake/$1"
}
fake apt-get <<'SH'
#!/bin/sh
echo "apt-get $*" >>"$(dirname "$0")/calls"
[ -e "$(dirname "$0")/broken" ] && { echo "E: no such luck"; exit 100; }
touch "$(dirname "$0")/installed"
SH
fake dpkg <<'SH'
#!/bin/sh
exit 0
SH
fake sudo <<'SH'
#!/bin/sh
[ "$1" = -n ] && shift
exec "$@"
SH
fake dpkg-query <<'SH'
#!/bin/sh
# -W -f FORMAT PACKAGE...
shift 3
for package; do
  case $package in
    libcli11-dev|libbox2d-dev) [ -e "$(dirname "$0")/installed" ] || continue ;;
  esac
  echo "$package installed"
done
SH
export PATH="$fake:$PATH"

# Before anything is built.
run help "$tree/plumb" --help
check "help before a build succeeds" same "$status" 0
check "help before a build names the tests' command" has "$work/help.out" "./plumb test"
for subcommand in test web bench field demo view compare thresholds scene; do
  run help "$tree/plumb" "$subcommand" --help
  check "help on $subcommand before a build says what it does" same "$status $(grep -c "$subcommand" "$work/help.out")" \
    "0 $(grep -cE "^  \./plumb (.*\| )?$subcommand( |$)" "$tree/plumb")"
done
run version "$tree/plumb" --version
check "version before a build" same "$(<"$work/version.out")" "plumb 0.1.0"
run bare "$tree/plumb"
check "no subcommand is a usage error" same "$status" 2
check "looking does not build" same "$(ls "$tree")" "$(printf 'CMakeLists.txt\nCMakePresets.json\nmain.cpp\nplumb')"

# Missing packages, and no leave to install them.
run refused "$tree/plumb" --no-install compare
check "--no-install with a package missing exits with 2" same "$status" 2
check "it names the package" has "$work/refused.err" "libcli11-dev"
check "it gives the command" has "$work/refused.err" \
  "apt-get install --no-install-recommends libcli11-dev libbox2d-dev"
check "its stdout is empty" empty "$work/refused.out"
check "it asks apt-get nothing" [ ! -e "$fake/calls" ]

touch "$fake/broken"
run broken "$tree/plumb" compare
check "a failing apt-get exits with 2" same "$status" 2
check "a failing apt-get is quoted" has "$work/broken.err" "E: no such luck"
rm "$fake/broken" "$fake/calls"

# The first call installs, builds and runs; through a symlink, from another folder.
mkdir "$work/bin" "$work/elsewhere"
ln -s "$tree/plumb" "$work/bin/plumb"
cd "$work/elsewhere"
run first "$work/bin/plumb" compare "two words" --flag
check "the first call succeeds" same "$status" 0
check "stdout is the program's alone" same "$(<"$work/first.out")" "[compare][two words][--flag] one"
check "it says what it installs" has "$work/first.err" "libcli11-dev"
check "it says why" has "$work/first.err" "reads the command line"
check "it installs without recommendations" has "$fake/calls" "--no-install-recommends"
check "tests are not built for a run" lacks "$tree/build/release/CMakeCache.txt" "PLUMB_TESTS:BOOL=ON"
check "the current folder stays clean" same "$(ls)" ""

# The second goes straight to work.
rm -f "$fake/calls"
begin=${EPOCHREALTIME/[.,]/}
run second "$work/bin/plumb" status 7
end=${EPOCHREALTIME/[.,]/}
check "the program's status is handed on" same "$status" 7
check "the second call sets nothing up" empty "$work/second.err"
check "the second call does not install" [ ! -e "$fake/calls" ]
check "the second call takes under a second: $(((end - begin) / 1000)) ms" [ $((end - begin)) -lt 1000000 ]

# Help is the program's own where it has it, of a part that is not built the script's; neither builds.
run own "$tree/plumb" compare --help
check "help on a subcommand once built" same "$(<"$work/own.out")" "[compare][--help] one"
run own "$tree/plumb" demo --help
check "help on a part that is not built" has "$work/own.out" "in a window"
run own "$tree/plumb" check -- mine --help
check "another program's --help is handed on" same "$(<"$work/own.out")" "[check][--][mine][--help] one"
check "help installs nothing" [ ! -e "$fake/calls" ]

# Edits are seen; errors are shown.
program two
run edited "$tree/plumb" list
check "an edit is seen" same "$(<"$work/edited.out")" "[list] two"
echo 'int main() { return undeclared_name; }' >"$tree/main.cpp"
run wrong "$tree/plumb" list
check "a build that fails exits with 2" same "$status" 2
check "its log is shown" has "$work/wrong.err" "undeclared_name"
check "nothing runs after it" empty "$work/wrong.out"

# Tests: their options reach ctest, and the configuration follows.
program three
run tests "$tree/plumb" test -R passes
check "a passing test" same "$status" 0
check "ctest's arguments select" lacks "$work/tests.out" "fails"
run tests "$tree/plumb" test
check "a failing test fails the call" [ "$status" -ne 0 ]
run after "$tree/plumb" list
check "a run after the tests does not configure again" empty "$work/after.err"

# A folder that was moved is configured again.
mv "$tree" "$work/moved"
run moved "$work/moved/plumb" list
check "a moved checkout works" same "$status $(<"$work/moved.out")" "0 [list] three"
mv "$work/moved" "$tree"

# Interrupted while it configures and while it builds, the next call goes on properly. The process group gets
# the signal, as it does from a terminal; the shell has its background commands ignore it, which is undone here.
cut_short() {
  env --default-signal=INT setsid "$tree/plumb" list >"$work/cut.out" 2>"$work/cut.err" </dev/null &
  local leader=$!
  sleep "$1"
  kill -INT -- "-$leader" 2>/dev/null || true
  wait "$leader" || if [[ $? == 130 ]]; then cuts=$((cuts + 1)); fi
}
cuts=0
rm -rf "$tree/build"
begin=${EPOCHREALTIME//[!0-9]/}
run whole "$tree/plumb" list
whole=$((${EPOCHREALTIME//[!0-9]/} - begin)) # us, of a first call on this machine
for percent in 10 25 40 55 70 85; do
  rm -rf "$tree/build"
  cut_short "$(printf '%d.%06d' $((whole * percent / 100 / 1000000)) $((whole * percent / 100 % 1000000)))"
  run healed "$tree/plumb" list
  check "going on after an interruption at $percent % of a call" same "$status $(<"$work/healed.out")" "0 [list] three"
done
check "interruptions did interrupt, with status 130" [ "$cuts" -ge 3 ]

# Two first calls at the same time.
rm -rf "$tree/build"
"$tree/plumb" list >"$work/one.out" 2>"$work/one.err" &
one=$!
run other "$tree/plumb" list
wait "$one" || status=1
check "two at the same time both succeed" same "$status" 0
check "and both answer" same "$(cat "$work/one.out" "$work/other.out")" "$(printf '[list] three\n[list] three')"

# Without apt-get and with the tools there it goes on, and leaves libraries for cmake to find.
bare="$work/bare"
mkdir "$bare"
for tool in bash env readlink mkdir flock grep rm mv cat cmake ninja sed nproc ctest c++ ld as "${CXX:-c++}"; do
  if found=$(command -v "$tool"); then ln -sf "$found" "$bare/$(basename "$tool")"; fi
done
run elsewhere env PATH="$bare" "$tree/plumb" list
check "a system without apt-get" same "$status $(<"$work/elsewhere.out")" "0 [list] three"
rm "$bare/ninja"
run toolless env PATH="$bare" "$tree/plumb" list
check "without apt-get a missing tool exits with 2" same "$status" 2
check "and is named" has "$work/toolless.err" "ninja-build"

if ((failures > 0)); then
  printf '%d checks failed\n' "$failures"
  exit 1
fi
