#!/usr/bin/env python3
"""Plants a bug a fuzz target in a copy of the checkout, and shows that its fuzzer finds it, from the corpus as it is.

    planted.py [--work DIR] [--only TARGET]... [--seconds S] [-j N]
    planted.py --match       checks only that each bug still has its place in the sources

Prints what was found and after how long. Exit status: 0 when every bug was found, 1 when one was not, 2 when the
sources or the build did not let it start. The copy and its build stay in DIR (build/planted).
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "support"), str(HERE.parent / "mutations")]
sys.dont_write_bytecode = True

import checkout_copy  # noqa: E402
import fuzz  # noqa: E402
from mutate import Mutation, mismatches  # noqa: E402

# The suite of a bug is the fuzz target that is to find it.
BUGS = [
    Mutation("a phase is not written", "engine/scene/json/json_writer.cpp",
             "if (value != rule.none) out_.key", 'if (value != rule.none && key != "phase") out_.key', suite="scene"),
    Mutation("awake bodies of a snapshot are not checked", "engine/world/snapshot/snapshot_check.cpp",
             'require(has_body(body) && listed.mark(body), "awake bodies", "are not there");', "listed.mark(body);",
             suite="snapshot"),
    Mutation("a list's length is believed", "engine/encoding/encoding.h",
             "require(count <= in_.size() / packed_size<T>(), field, \"is cut off\");", "", suite="recording"),
    Mutation("a sample's row may have any number of numbers", "reference/support/protocol.cpp",
             "if (!row.is_array() || row.size() != 6) {", "if (!row.is_array()) {", suite="host"),
    Mutation("a run before any scene", "reference/support/serve.cpp",
             'if (!simulator_) throw Error(Error::Kind::Run, "request", "run", "", "no scene is loaded");', "",
             suite="worker"),
    Mutation("a body that goes leaves what is its own", "engine/world/state/bodies.cpp",
             "if (w.bodies[body].uncommon != kNone) w.body_extras.remove(w.bodies[body].uncommon);", "", suite="world"),
]


def build(tree, target, jobs):
    """Builds the fuzzer of a target in the copy; returns the folder of the build."""
    folder = tree / "build" / "fuzz"
    checkout_copy.run(["cmake", "-S", tree, "--preset", "fuzz"])
    checkout_copy.run(["ninja", "-C", folder, f"-j{jobs}", f"fuzz_{target}"])
    return folder


def hunt(folder, target, seconds):
    """Runs the fuzzer with the corpus alone; returns the lines that say what was found, and the time."""
    for kept in ("corpus", "findings"):
        shutil.rmtree(folder / kept, ignore_errors=True)
    run = fuzz.Run(target, folder, seconds)
    run.start()
    run.process.wait()
    found = run.process.returncode != 0
    return (fuzz.explanation(run.log) if found else []), time.monotonic() - run.begin


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--only", action="append", metavar="TARGET")
    parser.add_argument("--seconds", type=float, default=180)
    parser.add_argument("-j", dest="jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--match", action="store_true")
    options = parser.parse_args()
    root = HERE.parent.parent
    problems = mismatches(root, BUGS)
    without = set(fuzz.all_targets()) - {bug.suite for bug in BUGS}
    problems += [f"no bug is planted for the target {target}" for target in sorted(without)]
    if problems:
        print("\n".join(problems), file=sys.stderr)
        return 2
    if options.match:
        print(f"{len(BUGS)} bugs have their place")
        return 0

    tree = (options.work or root / "build" / "planted") / "tree"
    missed = []
    for bug in [bug for bug in BUGS if not options.only or bug.suite in options.only]:
        checkout_copy.sync(root, tree)
        file = tree / bug.file
        file.write_text(bug.apply(file.read_text(encoding="utf-8")), encoding="utf-8")
        said, seconds = hunt(build(tree, bug.suite, options.jobs), bug.suite, options.seconds)
        print(f"{bug.suite:10} {bug.name}: {f'found after {seconds:.0f} s' if said else 'NOT FOUND'}", flush=True)
        for line in said[:2]:
            print(f"           {line}")
        if not said:
            missed.append(bug.suite)
    checkout_copy.sync(root, tree)
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
