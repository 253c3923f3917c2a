#!/usr/bin/env python3
"""Measures the cost of features for a scene, in instructions per step, which repeat exactly.

    features.py [--check] [--markdown] [--engine NAME]... PROGRAM

PROGRAM is plumb_features. It counts five scenes: no bodies ("empty"); 64 bodies in free fall ("rest"); the same bodies with
the feature declared in a way that has no effect ("declared": shapes, friction, restitution of bodies that nothing can touch);
a few bodies that use the feature ("feature"); and these together with the 64 ("both"). Then

    unused  = declared - rest                   cost of a feature that the scene does not use
    used    = feature - empty                   cost of the bodies that use it
    beside  = both - feature - rest + empty     additional cost of the 64, because other bodies use the feature

--check exits with 1 if `unused` is more than 1 % of the cost of the rest. Without valgrind the exit code is 77.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

STEPS = 64
BODIES = 64
NOISE = 0.01  # of the rest's own cost


def count(program, *arguments):
    """Returns the instructions per step; None if the engine skips the scene."""
    with tempfile.NamedTemporaryFile(prefix="plumb_features") as out:
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out.name}", "--collect-atstart=no",
                   "--toggle-collect=plumb_measured_steps", program, *arguments, str(STEPS)]
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
    if ran.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{ran.stdout}{ran.stderr}")
    if ran.stdout.startswith("skipped"):
        return None
    collected = re.search(r"Collected : (\d+)", ran.stderr)
    if not collected or int(collected.group(1)) == 0:
        sys.exit(f"callgrind counted nothing:\n{ran.stderr}")
    return int(collected.group(1)) / STEPS


def listed(program):
    engines, features = [], {}
    for line in subprocess.run([program], capture_output=True, text=True, check=True).stdout.splitlines():
        kind, name, *more = line.split(" ", 3)
        if kind == "engine":
            engines.append(name)
        else:
            features[name] = more[0] == "declared"
    return engines, features


def measure(program, engines, features):
    """Returns (engine, part, feature) -> instructions per step. `features`: by name, true if it can be declared."""
    runs = [(engine, part) for engine in engines for part in ("empty", "rest")]
    runs += [(engine, part, feature) for engine in engines for feature in features for part in ("feature", "both")]
    runs += [(engine, "declared", name) for engine in engines for name, can in features.items() if can]
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        counts = pool.map(lambda run: count(program, *run), runs)
    return dict(zip(runs, counts))


def rows(counts, engines, features):
    for engine in engines:
        empty, rest = counts[engine, "empty"], counts[engine, "rest"]
        for feature in features:
            alone, both = counts[engine, "feature", feature], counts[engine, "both", feature]
            if alone is None or both is None:
                continue
            declared = counts.get((engine, "declared", feature))
            yield (engine, feature, rest - empty, None if declared is None else declared - rest, alone - empty,
                   both - alone - rest + empty)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--markdown", action="store_true")
    parser.add_argument("--engine", action="append")
    parser.add_argument("program")
    options = parser.parse_args()
    if not shutil.which("valgrind"):
        print("valgrind is not installed: skipped")
        sys.exit(77)
    engines, features = listed(options.program)
    engines = options.engine or engines
    counts = measure(options.program, engines, features)
    too_much = []
    form = "| {} | {} | {} | {} | {} | {} |" if options.markdown else "{:<20}{:<13}{:>12}{:>12}{:>12}{:>20}"
    print(form.format("engine", "feature", f"{BODIES} others", "unused", "used", "beside"))
    if options.markdown:
        print("|---|---|--:|--:|--:|--:|")
    for engine, feature, rest, unused, used, beside in rows(counts, engines, features):
        text = "" if unused is None else f"{unused:+.1f}"
        print(form.format(engine, feature, f"{rest:.0f}", text, f"{used:.0f}", f"{beside:+.0f} ({100 * beside / rest:+.1f} %)"))
        if unused is not None and unused > NOISE * rest:
            too_much.append(f"{engine}: a scene that does not use {feature} pays {unused:.0f} instructions a step for it")
    if options.check and too_much:
        sys.exit("\n".join(too_much))


if __name__ == "__main__":
    main()
