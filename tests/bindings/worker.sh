#!/usr/bin/env bash
# Runs scenarios on plumb by way of a binding's protocol worker, and compares all errors with plumb's own: the same bits.
#
#   worker.sh LANGUAGE PREFIX PLUMB     PREFIX: where C is installed, Python's package, or the npm package
set -euo pipefail

language=$1 prefix=$(cd -- "$2" && pwd) plumb=$3
here=$(cd -- "$(dirname -- "$0")" && pwd)
root=$(cd -- "$here/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf -- "$work"' EXIT
cd "$work"
case $language in
  c)
    libraries=$(dirname "$(find "$prefix" -name libplumb.a)")
    read -ra flags <<<"$(PKG_CONFIG_PATH=$libraries/pkgconfig pkg-config --cflags --libs plumb-c)"
    cc -std=c99 -pedantic -Wall -Wextra -Werror "$root/bindings/c/examples/worker.c" "${flags[@]}" -o worker
    export LD_LIBRARY_PATH=$libraries
    command=./worker
    ;;
  python)
    export PYTHONPATH=$prefix PYTHONDONTWRITEBYTECODE=1
    command="/usr/bin/python3 $root/bindings/python/examples/worker.py"
    ;;
  javascript)
    tarball=$(npm pack --silent "$prefix")
    echo '{"private": true}' >package.json
    npm install --silent --offline --no-audit --no-fund "./$tarball"
    cp "$root/bindings/javascript/examples/worker.mjs" .
    command="node worker.mjs"
    ;;
  *)
    echo "unknown language $language"
    exit 2
    ;;
esac
# Its exit code says that an engine missed a bound, which the other one then misses too.
"$plumb" compare free_fall bounce pendulum_chain toppling_block --engine plumb,mine --engine-command "mine=$command" --no-cost \
  --out results >log 2>&1 || true
[[ -e results/results.jsonl ]] || { cat log && exit 1; }
python3 - results/results.jsonl <<'PYTHON'
import collections
import json
import sys

runs = collections.defaultdict(dict)
for line in open(sys.argv[1]):
    run = json.loads(line)
    if run["status"] == "ok":
        errors = {name: value for name, value in run["metrics"].items() if name != "expected_miss"}
        runs[run["label"]][run["engine"]] = errors
both = {label: run for label, run in runs.items() if len(run) == 2}
other = [label for label, run in both.items() if run["plumb"] != run["mine"]]
moving = sum(run["mine"]["position_error"] > 0 for run in both.values())
print(f"{len(both)} scenes on both, {moving} of them with an error; other bits in {other or 'none'}")
sys.exit(bool(other) or len(both) < 12 or moving < 8)
PYTHON
