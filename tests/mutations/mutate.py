#!/usr/bin/env python3
"""Plants physics bugs in a copy of the engine, one at a time, and shows that tests catch each: those of
agreement for what scenes show, the engine's own for Precise and for its real-time world, and those of the harness
for what judges them.

    mutate.py [--work DIR] [--only NAME]... [--compiler CXX] [-j N]
    mutate.py --features     plants those of features.py instead: one for each feature of the world
    mutate.py --list         names the bugs
    mutate.py --match        checks only that each bug still has its place in the sources
    mutate.py --self-test    tries the machinery on a project of one file

Exit status: 0 when every bug was caught, 1 when one survived, 2 when the sources or the tests did not let it
start. The copy and its build stay in DIR (build/mutations), so that a second run is quick.
"""

import argparse
import dataclasses
import os
import pathlib
import re
import shlex
import sys
import tempfile
import time
import xml.etree.ElementTree

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
sys.dont_write_bytecode = True

import checkout_copy  # noqa: E402


@dataclasses.dataclass(frozen=True)
class Mutation:
    """A bug: the text `old`, which stands exactly once in `file`, becomes `new`. A run of white space in `old`
    stands for any."""

    name: str
    file: str
    old: str
    new: str
    suite: str = "agreement"
    tests: tuple = ()  # files that must notice, as "world/shapes"; all of the suite when there are none

    def apply(self, text):
        place = re.compile(r"\s+".join(re.escape(word) for word in self.old.split()))
        count = len(place.findall(text))
        if count != 1:
            raise ValueError(f"{self.name}: the text to change stands {count} times in {self.file}, not once: "
                             f"{self.old!r}")
        if self.old == self.new:
            raise ValueError(f"{self.name}: changes nothing")
        return place.sub(lambda _: self.new, text)


def mismatches(root, mutations):
    """One sentence for each mutation that has lost its place."""
    problems = []
    for mutation in mutations:
        try:
            mutation.apply((root / mutation.file).read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            problems.append(str(error))
    names = [mutation.name for mutation in mutations]
    problems += [f"{name}: two mutations have this name" for name in set(names) if names.count(name) > 1]
    return problems


# Programs to build, and what ctest is to run of them.
SUITES = {
    "agreement": (["test_agreement"], ["-L", "agreement", "-LE", "slow", "-R", "plumb"]),
    "precise": (["test_precise"], ["-L", "unit", "-R", "^precise/"]),
    "scene": (["test_scene"], ["-L", "unit", "-R", "^scene/"]),
    "simulation": (["test_simulation"], ["-L", "unit", "-R", "^simulation/"]),
    "world": (["test_collision", "test_joints", "test_linear_algebra", "test_world", "test_world_solver",
               "test_world_threads"],
              ["-L", "unit", "-R", "^(collision|joints|linear_algebra|world)/"]),
    "harness": (["test_harness", "test_sweep"], ["-L", "unit", "-R", "^(harness|sweep)/"]),
    "features": (["test_extremes", "test_joints", "test_precise", "test_simulation", "test_world", "test_world_solver"],
                 ["-L", "unit"]),
}


def names_of(root, files):
    """A pattern of the tests in these files, for ctest."""
    names = set()
    for file in files:
        text = (root / "tests" / f"{file}_test.cpp").read_text(encoding="utf-8")
        found = re.findall(r"^(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+),", text, re.MULTILINE)
        names |= {f"^{file.rsplit('/', 1)[0]}/{prefix}{name}[./]" for name in found for prefix in ("", ".*/")}
    return "|".join(sorted(names))  # without groups: ctest bears few


class Tests:
    """The tests of a suite of a tree."""

    def __init__(self, tree, arguments, targets, select, jobs):
        self.tree, self.build = tree, checkout_copy.configure(tree, arguments)
        self.targets, self.select, self.jobs = targets, select, jobs

    def compile(self):
        return checkout_copy.run(["ninja", "-C", self.build, f"-j{self.jobs}", *self.targets], check=False)

    def failures(self, files=()):
        """Names of the tests that fail, and how many ran: of the suite, or of some of its files."""
        select = [*self.select, "-R", names_of(self.tree, files)] if files else self.select
        report = self.build / "mutation.xml"
        report.unlink(missing_ok=True)
        _, output = checkout_copy.run(["ctest", "--test-dir", self.build, f"-j{self.jobs}", "--timeout", "120",
                                       "--output-junit", report, *select], check=False)
        if not report.exists():
            raise SystemExit(f"{output}\nctest wrote no report")
        cases = xml.etree.ElementTree.parse(report).getroot().findall("testcase")
        failing = [case.get("name") for case in cases if case.get("status") == "fail"]
        return failing, len(failing) + sum(case.get("status") == "run" for case in cases)


def unplanted(root, mutations):
    """Features of the guide's table that no mutation takes away."""
    table = (root / "docs" / "guide" / "README.md").read_text(encoding="utf-8").split("## Features")[1]
    rows = re.findall(r"^\| ([^|*]+?) \| (?!how|---|not yet)", table, re.MULTILINE)
    return sorted(set(rows) - {mutation.name for mutation in mutations})


def describe(names):
    """A few of the tests by name, and how many more."""
    shown = ", ".join(re.sub(r"^agreement/(.*KeepsEveryBound/)?", "", name) for name in names[:3])
    return shown + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def plant(root, work, mutations, tests_of, say=print):
    """Plants each mutation in a copy of `root`; returns the names of those that survive."""
    tree = work / "tree"
    checkout_copy.sync(root, tree)
    tests = tests_of(tree)
    status, output = tests.compile()
    if status != 0:
        raise SystemExit(f"{output}\nthe copy does not build without a mutation")
    failing, count = tests.failures({file for mutation in mutations for file in mutation.tests})
    if failing or count == 0:
        raise SystemExit(f"without a mutation {len(failing)} of {count} tests fail: {describe(failing)}")
    say(f"without a mutation all {count} tests pass", flush=True)

    survivors = []
    width = max(len(mutation.name) for mutation in mutations)
    for mutation in mutations:
        begin = time.monotonic()
        file = tree / mutation.file
        text = file.read_text(encoding="utf-8")
        try:
            file.write_text(mutation.apply(text), encoding="utf-8")
            status, output = tests.compile()
            caught, count = tests.failures(mutation.tests) if status == 0 else ([], 0)
        finally:
            file.write_text(text, encoding="utf-8")
        verdict = f"caught by {len(caught)} of {count}: {describe(caught)}" if caught else "SURVIVED"
        if status != 0:
            verdict = f"DOES NOT COMPILE: {output[-2000:]}"
        say(f"{mutation.name:{width}}  {verdict}  [{time.monotonic() - begin:.0f} s]", flush=True)
        if not caught:
            survivors.append(mutation.name)
    return survivors


def self_test():
    """A project of one file and one test: a mutation that is caught, one that survives, one without a place."""
    sources = {
        "CMakeLists.txt": "cmake_minimum_required(VERSION 3.25)\nproject(fall LANGUAGES CXX)\nenable_testing()\n"
                          "add_executable(fall fall.cpp)\nadd_test(NAME agreement/fall COMMAND fall)\n"
                          "set_tests_properties(agreement/fall PROPERTIES LABELS agreement)\n",
        "fall.cpp": "double unused() { return 1; }\n"
                    "double height(double t) { return 10 - 9.81 * t * t / 2; }\n"
                    "int main() { return height(2) == 10 - 9.81 * 2 ? 0 : 1; }\n",
    }
    caught = Mutation("gravity twice", "fall.cpp", "t * t / 2", "t * t")
    survives = Mutation("never called", "fall.cpp", "return 1;", "return 2;")
    lost = Mutation("no place", "fall.cpp", "t * t * t", "t")
    twice = Mutation("two places", "fall.cpp", "return", "throw")
    with tempfile.TemporaryDirectory() as name:
        root, work = pathlib.Path(name) / "checkout", pathlib.Path(name) / "work"
        root.mkdir()
        for path, text in sources.items():
            (root / path).write_text(text, encoding="utf-8")

        def tests_of(tree):
            return Tests(tree, [], ["all"], ["-L", "agreement"], 1)

        assert mismatches(root, [caught, survives]) == []
        assert len(mismatches(root, [caught, lost, twice])) == 2
        assert len(mismatches(root, [caught, caught])) == 1
        assert plant(root, work, [caught, survives], tests_of) == ["never called"]
        for path, text in sources.items():
            assert (root / path).read_text(encoding="utf-8") == text, "the checkout was changed"
        assert plant(root, work, [caught], tests_of) == []
    print("one caught, one survived, three refused")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--only", action="append", metavar="NAME")
    parser.add_argument("--compiler", default=os.environ.get("CXX", "c++"))
    parser.add_argument("-j", dest="jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--features", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--match", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    if options.self_test:
        return self_test()

    from bugs import MUTATIONS as bugs
    from features import FEATURES

    root = HERE.parent.parent
    mutations = FEATURES if options.features else bugs
    if options.list:
        for mutation in mutations:
            print(f"{mutation.name:48}  {mutation.file}")
        return 0
    problems = mismatches(root, bugs) + mismatches(root, FEATURES)
    problems += [f"{row}: features.py plants nothing for it" for row in unplanted(root, FEATURES)]
    if problems:
        print("\n".join(problems), file=sys.stderr)
        return 2
    if options.match:
        print(f"{len(bugs) + len(FEATURES)} mutations have their place")
        return 0
    unknown = set(options.only or []) - {mutation.name for mutation in mutations}
    if unknown:
        print(f"no mutation is called {' or '.join(sorted(unknown))}; see --list", file=sys.stderr)
        return 2
    chosen = [mutation for mutation in mutations if not options.only or mutation.name in options.only]

    # The flags of the checkout's own build: what a compiler cache has seen there is not compiled again.
    arguments = [f"-DCMAKE_CXX_COMPILER={options.compiler}", "-DPLUMB_BENCHES=OFF",
                 *shlex.split(os.environ.get("PLUMB_CMAKE_FLAGS", ""))]
    survivors = []
    for suite, (targets, select) in SUITES.items():
        of_suite = [mutation for mutation in chosen if mutation.suite == suite]
        if of_suite:
            survivors += plant(root, options.work or root / "build" / "mutations", of_suite,
                               lambda tree: Tests(tree, arguments, targets, select, options.jobs))
    print(f"{len(chosen) - len(survivors)} of {len(chosen)} caught" +
          (f"; survived: {', '.join(survivors)}" if survivors else ""))
    return 1 if survivors else 0


if __name__ == "__main__":
    sys.exit(main())
