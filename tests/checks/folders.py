#!/usr/bin/env python3
"""Checks that each folder of engine/ and scenarios/ compiles as one source, as the preset `library` and the page for
browsers do: names that are hidden in a file (anonymous namespaces) are unique within their folder, or shared by a header,
and are none of the headers that are precompiled there; each scenario has a namespace of its own.

    folders.py BUILD     a build folder with compile_commands.json

Files that engine/CMakeLists.txt leaves out of it, or gives options of their own, are left out here. A build with
PLUMB_UNITY has compiled the folders so itself, and leaves nothing to check.
"""

import collections
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

APART = {"integrate/dop853.cpp", "linear_algebra/joint_system_hinges.cpp"}
OPTIONS_OF_THEIR_OWN = "-fno-tree-slp-vectorize"
PRECOMPILED = ["engine/world/world_data.h", "engine/scene/scene.h"]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = pathlib.Path(__file__).resolve().parents[2]
    engine = root / "engine"
    folders = collections.defaultdict(list)
    for entry in json.loads((pathlib.Path(sys.argv[1]) / "compile_commands.json").read_text(encoding="utf-8")):
        file = pathlib.Path(entry["file"])
        if engine not in file.parents and root / "scenarios" not in file.parents:
            continue
        if engine in file.parents and str(file.relative_to(engine)) in APART:
            continue
        if OPTIONS_OF_THEIR_OWN not in entry["command"]:
            folders[file.parent].append(entry)
    wrong = 0
    for folder, entries in sorted(folders.items()):
        if len(entries) < 2:
            continue
        command = shlex.split(re.sub(r" -(o|c|MF|MT) \S+| -MD", "", entries[0]["command"]))
        if pathlib.Path(command[0]).name == "cmake":  # cmake -E env NAME=VALUE ccache COMPILER ...
            command = command[next(i for i, word in enumerate(command) if word.endswith("ccache")) + 1:]
        with tempfile.NamedTemporaryFile("w", suffix=".cpp") as source:
            if engine in folder.parents:
                source.write("".join(f'#include "{root / header}"\n' for header in PRECOMPILED))
            source.write("".join(f'#include "{entry["file"]}"\n' for entry in entries))
            source.flush()
            run = subprocess.run(command + ["-w", "-fsyntax-only", source.name], cwd=entries[0]["directory"],
                                 capture_output=True, text=True)
        if run.returncode != 0:
            wrong += 1
            print(f"{folder.relative_to(root)}: names of its files collide, or cannot be compiled as one source")
            print("\n".join(line for line in run.stderr.splitlines() if "error" in line)[:2000])
    print(f"{len(folders)} folders, {wrong} problems")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
