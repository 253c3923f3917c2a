#!/usr/bin/env python3
"""Plants bugs of bugs.py in a copy of the checkout, hunts each with `plumb hunt` and counts what it finds there and
not in the engine as it is: the same seed draws the same scenes.

    hunted.py [--draw 20] [--draw-seed 32] [--seconds 300] [--jobs 2] [--hunt-seed 1] [--out DIR] [--work DIR]
    hunted.py --list         names the bugs that are drawn

The bugs are drawn from those in engine/, whatever they break; each is hunted in the engines that its suite tests,
in as many scenes as take about so many seconds of processor time. A finding is new where its scene, engine and
judge have none in the unchanged engine. A bug is caught where a judge objects to a family of scenes, in an engine,
to which it does not object at all without the bug: chaos moves findings from scene to scene. Bugs whose hunt is in DIR (build/hunted) are not hunted again. Exit status:
0 when three of four were caught, else 1.
"""

import argparse
import collections
import concurrent.futures
import json
import pathlib
import random
import shlex
import shutil
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "support")]
sys.dont_write_bytecode = True

import checkout_copy  # noqa: E402
from bugs import MUTATIONS  # noqa: E402

# By the suite of a bug: the engines that are hunted, and how many scenes they judge in a second.
ENGINES = {
    "world": ("plumb-float", 12),
    "simulation": ("plumb", 12),
    "agreement": ("plumb-float,plumb", 11),
    "precise": ("plumb-precise", 4),
}


def drawn(count, seed):
    return random.Random(seed).sample([bug for bug in MUTATIONS if bug.file.startswith("engine/")], count)


def read(folder):
    """The scenes of a hunt that were judged to the end, with how many engines ran them, and its findings."""
    scenes, findings = {}, {}
    for line in (folder / "hunt.jsonl").read_text(encoding="utf-8").splitlines():
        try:
            entry = json.loads(line)
        except ValueError:
            continue
        if "scene" in entry and "runs" in entry:
            scenes[entry["scene"]] = entry["runs"]
        finding = entry.get("finding")
        if finding and (not finding["shrunk"] or finding["judge"] == "crash"):
            family = finding["case"]["idioms"][1]
            findings[entry["scene_of"], finding["engine"], finding["judge"], family] = finding["what"]
    return scenes, findings


def hunt(program, folder, suite, options):
    engines, rate = ENGINES[suite]
    folder.mkdir(parents=True, exist_ok=True)
    begin = time.monotonic()
    _, output = checkout_copy.run(["nice", "-n", "19", program, "hunt", "--engine", engines, "--jobs", "1", "--shrinks", "0",
                                   "--seed", options.hunt_seed, "--scenes", int(rate * options.seconds), "--out", folder],
                                  check=False)
    (folder / "table.txt").write_text(output, encoding="utf-8")
    print(f"hunted: {folder.parent.name} {suite} [{time.monotonic() - begin:.0f} s]", flush=True)


def compare(base, other):
    """New findings, those that are gone, the new kinds, and of how many scenes. Scenes that an engine did not run both times
    (it was too slow, or refused them) say nothing."""
    (scenes, known), (others, found) = base, other
    crashed = {key[0] for key in found if key[2] == "crash"}
    both = {scene for scene, runs in scenes.items() if others.get(scene) == runs or scene in crashed}
    new = {key: what for key, what in found.items() if key[0] in both and key not in known}
    gone = [key for key in known if key[0] in both and key[0] not in crashed and key not in found]
    kinds = collections.Counter(key[1:] for key in new if key[1:] not in {other[1:] for other in known})
    return new, gone, kinds, len(both)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draw", type=int, default=20)
    parser.add_argument("--draw-seed", type=int, default=32)
    parser.add_argument("--seconds", type=float, default=300)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--hunt-seed", type=int, default=1)
    root = HERE.parent.parent
    parser.add_argument("--out", type=lambda path: pathlib.Path(path).resolve(), default=root / "build" / "hunted")
    parser.add_argument("--work", type=lambda path: pathlib.Path(path).resolve(), default=root / "build" / "mutations")
    parser.add_argument("--cmake", default="", help="more arguments of cmake")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    bugs = drawn(options.draw, options.draw_seed)
    if options.list:
        print("\n".join(f"{bug.name:64} {bug.file}" for bug in bugs))
        return 0

    tree = options.work / "tree"
    checkout_copy.sync(root, tree)
    build = checkout_copy.configure(tree, ["-DPLUMB_BENCHES=OFF", "-DPLUMB_TESTS=OFF", "-DPLUMB_WINDOW=OFF",
                                           *shlex.split(options.cmake)])

    # 0 is the engine as it is.
    tasks = [(0, suite) for suite in ENGINES if suite in {bug.suite for bug in bugs}]
    tasks += [(number, bug.suite) for number, bug in enumerate(bugs, 1)]

    def folder_of(number, suite):
        return options.out / f"{number:02}" / suite

    def program_of(number):
        """Plants the bug and builds; the program's copy is in a folder of its own, with the other workers."""
        folder = options.out / f"{number:02}"
        if (folder / "plumb").exists():
            return folder / "plumb"
        bug = bugs[number - 1] if number else None
        file = tree / (bug.file if bug else "README.md")
        text = file.read_text(encoding="utf-8")
        try:
            if bug:
                file.write_text(bug.apply(text), encoding="utf-8")
            checkout_copy.run(["ninja", "-C", build, "programs"])
        finally:
            file.write_text(text, encoding="utf-8")
        folder.mkdir(parents=True, exist_ok=True)
        for made in (build / "bin").iterdir():
            shutil.copy(made, folder)
        return folder / "plumb"

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        waiting = [pool.submit(hunt, program_of(number), folder_of(number, suite), suite, options)
                   for number, suite in tasks if not (folder_of(number, suite) / "table.txt").exists()]
        for each in waiting:
            each.result()

    caught = 0
    for number, bug in enumerate(bugs, 1):
        new, gone, kinds, scenes = compare(read(folder_of(0, bug.suite)), read(folder_of(number, bug.suite)))
        caught += bool(kinds)
        text = ", ".join(f"{count} {judge} of a {family} ({engine})"
                         for (engine, judge, family), count in kinds.most_common(4))
        print(f"{'caught' if kinds else 'MISSED'}  {bug.name}: {len(new)} new, {len(gone)} gone of {scenes} scenes" +
              (f"; {text}" if text else ""))
    print(f"{caught} of {len(bugs)} caught")
    return 0 if 4 * caught >= 3 * len(bugs) else 1


if __name__ == "__main__":
    sys.exit(main())
