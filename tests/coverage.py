#!/usr/bin/env python3
"""Prints how much of engine/ a build for coverage has run: lines and branches, by folder.

    coverage.py BUILD [FOLDER]    BUILD was compiled with --coverage and its tests were run; FOLDER (engine) is counted
    coverage.py --self-test       a program of one file, with known figures

A line or branch counts once, however many programs or instances of a template it is in. Edges of exceptions, which each
call has, are no branches here. `./plumb test --coverage` builds, runs and prints.
"""

import collections
import json
import pathlib
import subprocess
import sys
import tempfile


def counted(build, root, folder):
    """The times each line, and each way of each branch, was run, by file of `folder`: ({line: n}, {(line, i): n})."""
    files = collections.defaultdict(lambda: (collections.Counter(), collections.Counter()))
    notes = sorted(str(path.resolve()) for path in pathlib.Path(build).rglob("*.gcno"))
    for first in range(0, len(notes), 64):
        run = subprocess.run(["gcov", "--json-format", "--stdout", "--branch-probabilities", *notes[first:first + 64]],
                             cwd=build, capture_output=True, text=True, check=True)
        for line in run.stdout.splitlines():
            if not line.startswith("{"):
                continue
            unit = json.loads(line)
            for file in unit["files"]:
                path = (pathlib.Path(unit["current_working_directory"]) / file["file"]).resolve()
                if not path.is_relative_to(root / folder):
                    continue
                lines, branches = files[path.relative_to(root)]
                for each in file["lines"]:
                    lines[each["line_number"]] += each["count"]
                    ways = [way for way in each["branches"] if not way["throw"]]
                    for i, way in enumerate(ways):
                        branches[each["line_number"], i] += way["count"]
    return files


def share(counts):
    return sum(1 for count in counts if count), len(counts)


def report(files):
    rows = collections.defaultdict(lambda: [0, 0, 0, 0])
    for path, (lines, branches) in files.items():
        figures = [*share(lines.values()), *share(branches.values())]
        for name in (str(path.parent), "all"):
            rows[name] = [a + b for a, b in zip(rows[name], figures)]
    width = max(map(len, rows))
    print(f"{'':{width}}  {'lines':>16}  {'branches':>16}")
    for name in sorted(rows, key=lambda each: (each == "all", each)):
        hit, count, ways, all_ways = rows[name]
        print(f"{name:{width}}  {part(hit, count)}  {part(ways, all_ways)}")
    return rows["all"]


def part(hit, count):
    return f"{100 * hit / count:5.1f} % of {count:>5}" if count else f"{'-':>16}"


def self_test():
    text = "int sign(int x) {\n  if (x > 0)\n    return 1;\n  return 0;\n}\nint main() { return sign(1) - 1; }\n"
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder).resolve()
        (root / "engine").mkdir()
        (root / "engine/a.cpp").write_text(text)
        subprocess.run(["g++", "--coverage", "-O0", "engine/a.cpp", "-o", "a"], cwd=root, check=True)
        subprocess.run(["./a"], cwd=root, check=True)
        assert report(counted(root, root, "engine")) == [4, 5, 1, 2], "figures of the self-test"
        assert not counted(root, root, "elsewhere")


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    files = counted(sys.argv[1], pathlib.Path(__file__).resolve().parents[1], sys.argv[2] if len(sys.argv) == 3 else "engine")
    if not files:
        sys.exit(f"{sys.argv[1]} has no notes of coverage: compile it with --coverage, and run its tests")
    report(files)


if __name__ == "__main__":
    main()
