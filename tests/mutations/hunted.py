#!/usr/bin/env python3
"""Plants bugs of bugs.py in a copy of the checkout, hunts each with `plumb hunt` and counts what it finds there and
not in the engine as it is: the same seed draws the same scenes.

    hunted.py [--draw 20] [--draw-seed 32] [--seconds 300] [--jobs 2] [--hunt-seed 1] [--out DIR] [--work DIR]
    hunted.py --bugs A,B     bugs whose names contain these words, in place of drawn ones
    hunted.py --list         names the bugs that are drawn
    hunted.py --report       says what is known so far, and hunts nothing

The bugs are drawn from those in engine/, whatever they break; each is hunted in the engines that its suite tests. A
bug is caught where a judge objects to a family of scenes, in an engine, to which it does not object at all in the
engine as it is, in any of its scenes: chaos moves findings from scene to scene. The hunt of a bug stops when it is
caught, or has taken so many seconds of processor time, its processes' together. The hunt of the engine as it is is
shared: it has as many scenes as that of a bug, and at least --scenes before one counts as caught.

All that is done stays in --out (build/hunted): the same command goes on from there. Bugs are hunted in rounds, each
of more time for those that are not caught yet. Exit status: 0 when three of four were caught, else 1.
"""

import argparse
import collections
import json
import os
import pathlib
import random
import shlex
import shutil
import subprocess
import sys
import threading

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "support")]
sys.dont_write_bytecode = True

import checkout_copy  # noqa: E402
from bugs import MUTATIONS  # noqa: E402

# By the suite of a bug: the engines that are hunted.
ENGINES = {
    "world": "plumb-float",
    "simulation": "plumb",
    "agreement": "plumb-precise,plumb-float,plumb",
    "precise": "plumb-precise",
    "scene": "plumb-float,plumb",
    "linear_algebra": "plumb-precise,plumb-float,plumb",
    "collision": "plumb-float,plumb",
}
# Of the programs and builds, beside what else a machine does.
NICE = "10"
# Scenes that are drawn before findings are looked at again.
BATCH = 25
# Shares of the time that each bug gets in a round, before any gets more.
ROUNDS = (0.1, 0.4, 1)


def drawn(count, seed):
    return random.Random(seed).sample([bug for bug in MUTATIONS if bug.file.startswith("engine/")], count)


class Hunt:
    """A hunt in a folder, of which more and more scenes are drawn. `seconds` of processor time were spent."""

    def __init__(self, program, folder, engines, seed):
        self.program, self.folder, self.engines, self.seed = program, folder, engines, seed
        self.lock = threading.Lock()
        self.used = folder / "seconds.json"
        self.seconds = json.loads(self.used.read_text(encoding="utf-8")) if self.used.exists() else 0.0
        self.scenes, self.findings = {}, {}
        self.read()

    def read(self):
        """The scenes that were judged to the end, with how many engines ran them, and the findings."""
        log = self.folder / "hunt.jsonl"
        for line in log.read_text(encoding="utf-8").splitlines() if log.exists() else []:
            try:
                entry = json.loads(line)
            except ValueError:
                continue
            if "scene" in entry:
                self.scenes[entry["scene"]] = entry.get("runs", 0)
            finding = entry.get("finding")
            if finding and (not finding["shrunk"] or finding["judge"] == "crash"):
                family = finding["case"]["idioms"][1]
                key = (entry["scene_of"], finding["engine"], finding["judge"], family)
                self.findings.setdefault(key, finding["what"])

    def draw(self, scenes):
        """Goes on until so many scenes are drawn."""
        with self.lock:
            if len(self.scenes) >= scenes:
                return
            self.folder.mkdir(parents=True, exist_ok=True)
            command = ["nice", "-n", NICE, self.program, "hunt", "--engine", self.engines, "--jobs", "1", "--shrinks", "0",
                       "--seed", self.seed, "--scenes", scenes, "--out", self.folder]
            child = subprocess.Popen([str(word) for word in command], stdin=subprocess.DEVNULL,
                                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                     env=checkout_copy.environment())
            _, _, usage = os.wait4(child.pid, 0)
            child.returncode = 0
            self.seconds += usage.ru_utime + usage.ru_stime
            self.used.write_text(json.dumps(self.seconds), encoding="utf-8")
            before = len(self.scenes)
            self.read()
            if len(self.scenes) == before:
                raise SystemExit(f"{' '.join(map(str, command))}: drew nothing")


def kinds_of(base, other):
    """(engine, judge, family) that the other hunt has and the base has in none of its scenes, with their scenes. A
    scene that an engine did not run both times (it was too slow, or refused it) says nothing, unless it crashed."""
    known = {key[1:] for key in base.findings}
    kinds = collections.defaultdict(list)
    for key in other.findings:
        scene = key[0]
        same = base.scenes.get(scene) == other.scenes.get(scene) or key[2] == "crash"
        if scene in base.scenes and same and key[1:] not in known:
            kinds[key[1:]].append(scene)
    return kinds


class Bench:
    """The copy of the checkout in which bugs are planted, and their programs."""

    def __init__(self, root, options):
        self.options, self.lock = options, threading.Lock()
        self.root, self.tree, self.build = root, options.work / "tree", None

    def prepare(self):
        if self.build is None:
            checkout_copy.sync(self.root, self.tree)
            self.build = checkout_copy.configure(
                self.tree, ["-DPLUMB_BENCHES=OFF", "-DPLUMB_TESTS=OFF", "-DPLUMB_WINDOW=OFF",
                            *shlex.split(self.options.cmake)])

    def program_of(self, number, bug):
        """Plants the bug and builds; the program's copy is in a folder of its own, with the other workers."""
        folder = self.options.out / f"{number:02}"
        with self.lock:
            if (folder / "plumb").exists():
                return folder / "plumb"
            self.prepare()
            file = self.tree / (bug.file if bug else "README.md")
            text = file.read_text(encoding="utf-8")
            try:
                if bug:
                    file.write_text(bug.apply(text), encoding="utf-8")
                checkout_copy.run(["nice", "-n", NICE, "ninja", "-C", self.build, "programs"])
            finally:
                file.write_text(text, encoding="utf-8")
            folder.mkdir(parents=True, exist_ok=True)
            # The program last: it stands for all of them.
            for made in sorted((self.build / "bin").iterdir(), key=lambda path: path.name == "plumb"):
                shutil.copy(made, folder)
            return folder / "plumb"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--draw", type=int, default=20)
    parser.add_argument("--draw-seed", type=int, default=32)
    parser.add_argument("--seconds", type=float, default=300, help="of processor time, for each bug")
    parser.add_argument("--scenes", type=int, default=1000, help="least number of the engine as it is")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--hunt-seed", type=int, default=1)
    root = HERE.parent.parent
    parser.add_argument("--out", type=lambda path: pathlib.Path(path).resolve(), default=root / "build" / "hunted")
    parser.add_argument("--work", type=lambda path: pathlib.Path(path).resolve(), default=root / "build" / "mutations")
    parser.add_argument("--cmake", default="", help="more arguments of cmake")
    parser.add_argument("--bugs", default="", help="words of names, by commas")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--report", action="store_true")
    options = parser.parse_args()
    bugs = drawn(options.draw, options.draw_seed)
    if options.bugs:
        words = options.bugs.split(",")
        bugs = [bug for bug in MUTATIONS if bug.file.startswith("engine/") and any(word in bug.name for word in words)]
    if options.list:
        print("\n".join(f"{bug.name:64} {bug.file}" for bug in bugs))
        return 0

    bench = Bench(root, options)

    def hunt_of(number, suite):
        program = options.out / f"{number:02}" / "plumb"
        return Hunt(program, options.out / f"{number:02}" / suite, ENGINES[suite], options.hunt_seed)

    # 0 is the engine as it is.
    bases = {suite: hunt_of(0, suite) for suite in ENGINES if suite in {bug.suite for bug in bugs}}
    hunts = [hunt_of(number, bug.suite) for number, bug in enumerate(bugs, 1)]

    def least_of(suite):
        """Scenes of the engine as it is that a catch is held against. Those of precise take thrice as long."""
        return options.scenes // 3 if suite == "precise" else options.scenes

    def hunt_one(number, seconds):
        bug, base, other = bugs[number - 1], bases[bugs[number - 1].suite], hunts[number - 1]
        while not kinds_of(base, other) and other.seconds < seconds:
            bench.program_of(number, bug)
            other.draw(len(other.scenes) + BATCH)
            base.draw(len(other.scenes))
            if kinds_of(base, other):  # or so it seems
                base.draw(least_of(bug.suite))
        kinds = kinds_of(base, other)
        print(f"{'caught' if kinds else 'not yet'}: {bug.name}, {len(other.scenes)} scenes in {other.seconds:.0f} s",
              flush=True)

    def in_turn(work, tasks):
        waiting, failed = list(tasks), []

        def serve():
            while waiting and not failed:
                try:
                    work(*waiting.pop(0))
                except BaseException as error:  # noqa: BLE001
                    failed.append(error)

        workers = [threading.Thread(target=serve) for _ in range(options.jobs)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        if failed:
            raise failed[0]

    if not options.report:
        bench.program_of(0, None)
        for share in ROUNDS:
            in_turn(hunt_one, [(number, share * options.seconds) for number in range(1, len(bugs) + 1)])

    caught = finished = 0
    for bug, other in zip(bugs, hunts):
        kinds = kinds_of(bases[bug.suite], other)
        spent = other.seconds >= options.seconds
        caught, finished = caught + bool(kinds), finished + bool(kinds or spent)
        text = ", ".join(f"{judge} of a {family} ({engine}, scene {min(scenes)})" for (engine, judge, family), scenes in
                         sorted(kinds.items(), key=lambda kind: min(kind[1]))[:4])
        state = "caught" if kinds else "MISSED" if spent else "not yet"
        print(f"{state:7} {bug.name}: {len(other.scenes)} scenes, {other.seconds:.0f} s" +
              (f"; {text}" if text else ""))
    print(f"{caught} of {len(bugs)} caught" + (f", {finished} hunted to the end" if finished < len(bugs) else ""))
    return 0 if 4 * caught >= 3 * len(bugs) else 1


if __name__ == "__main__":
    sys.exit(main())
