#!/usr/bin/env python3
"""Checks that includes point the way that docs/design.md says, and that no two parts of the engine depend on
each other.

    include_direction.py CHECKOUT          exit 1 when an include points the wrong way
    include_direction.py --self-test       shows that each rule can be broken
    include_direction.py --graph CHECKOUT  prints which part of the engine uses which
"""

import pathlib
import re
import sys
import tempfile

# What the files below a folder may include, as prefixes of paths from the checkout's root; the longest folder
# that contains a file decides. A folder that stands here without a slash at the end is a single header.
EVERYTHING = ["engine/", "reference/", "scenarios/", "harness/", "extremes/"]
RULES = {
    "engine": ["engine/"],
    "engine/math": ["engine/math/"],
    "engine/core": ["engine/core/"],
    "engine/scene": ["engine/scene/", "engine/core/", "engine/math/"],
    "scenarios": ["scenarios/", "engine/scene/", "engine/core/", "engine/math/", "reference/backend.h"],
    "reference": ["reference/", "engine/"],
    "harness": ["harness/", "scenarios/", "reference/", "engine/"],
    "extremes": ["extremes/", "harness/stress/", "scenarios/truth/", "engine/scene/", "engine/core/", "engine/math/"],
    "app": ["app/", "demos/"] + EVERYTHING,
    "demos": ["demos/"] + EVERYTHING,
    "demos/core": ["demos/core/", "engine/"],
    "bench": ["bench/"] + EVERYTHING,
    "bindings": ["bindings/", "engine/"],
    "tests": ["tests/", "app/", "demos/", "bindings/"] + EVERYTHING,
}

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"]+)"', re.MULTILINE)
SUFFIXES = {".h", ".hpp", ".cpp", ".in"}
OWN_FOLDERS = ("engine", "scenarios", "reference", "harness", "extremes", "app", "demos", "bench", "bindings", "tests")


def rule_for(path):
    """The prefixes that a file may include."""
    folder = pathlib.PurePosixPath(path).parent
    for candidate in [folder, *folder.parents]:
        if str(candidate) in RULES:
            return RULES[str(candidate)]
    return []


def sources(root):
    for folder in OWN_FOLDERS:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in SUFFIXES and file.is_file():
                yield file.relative_to(root).as_posix(), file.read_text(encoding="utf-8")


def wrong_includes(root):
    """One sentence for each include that no rule allows."""
    problems = []
    for path, text in sources(root):
        # The consumer's project and the like are projects of their own, with the engine as a library.
        allowed = ["engine/"] if path.startswith("tests/install/") else rule_for(path)
        for match in INCLUDE.finditer(text):
            target = match.group(1)
            line = text.count("\n", 0, match.start()) + 1
            generated = (root / f"{target}.in").is_file()
            if not generated and not (root / target).is_file():
                problems.append(f'{path}:{line}: "{target}" is not a path from the root of the project')
            elif not any(target.startswith(prefix) for prefix in allowed):
                problems.append(f'{path}:{line}: must not include "{target}"; may: {" ".join(allowed)}')
    return problems


# Public headers of the world stand on top of its folder; each belongs to the part that implements it.
PARTS = {
    "engine/world/state": ["definitions.h", "events.h", "handles.h", "integrator.h", "profile.h", "solver.h", "world.h",
                           "world_data.h"],
    "engine/world/monitor": ["invariant_monitor.h"],
    "engine/world/snapshot": ["rollback.h", "snapshot.h", "snapshot_check.h", "state_hash.h"],
    "engine/world/recording": ["recorder.h", "replay.h"],
    "engine/world/drawing": ["debug_draw.h", "past_poses.h", "svg_draw.h"],
    "engine/world/queries": ["queries.h"],
    "engine/world/character": ["mover.h"],
    "engine/world/forces": ["force_laws.h"],
    "engine/world/scene": ["add_scene.h"],
    "engine/core": ["checksum.h"],
}
PART_OF = {f"engine/world/{header}": part for part, headers in PARTS.items() for header in headers}


def part_of(path):
    """The part of the engine that a file belongs to: its folder, or for a public header what implements it."""
    return PART_OF.get(path, str(pathlib.PurePosixPath(path).parent))


def engine_graph(root):
    """Part of the engine -> {part that it includes: [path, ...]}."""
    graph = {}
    for path, text in sources(root):
        if not path.startswith("engine/"):
            continue
        edges = graph.setdefault(part_of(path), {})
        for target in INCLUDE.findall(text):
            if target.startswith("engine/") and part_of(target) != part_of(path):
                edges.setdefault(part_of(target), []).append(f'{path} includes "{target}"')
    return graph


def cycles(graph):
    """Every strongly connected set of two folders or more, each with the includes inside it."""

    def reachable(start):
        seen, queue = set(), [start]
        while queue:
            for to in graph.get(queue.pop(), {}):
                if to not in seen:
                    seen.add(to)
                    queue.append(to)
        return seen

    reach = {folder: reachable(folder) for folder in graph}
    found = {frozenset(b for b in reach[a] if a in reach.get(b, ())) for a in graph if a in reach[a]}
    problems = []
    for folders in sorted(found, key=sorted):
        inside = [text for a in sorted(folders) for b in sorted(folders) for text in graph[a].get(b, [])]
        problems.append(f"parts of the engine depend on each other: {', '.join(sorted(folders))}\n    "
                        + "\n    ".join(inside))
    return problems


def self_test():
    """Each rule is broken once in a tree of a few files."""
    good = {
        "engine/math/vec2.h": "",
        "engine/scene/scene.h": '#include "engine/math/vec2.h"\n',
        "engine/simulation/simulation.h": '#include "engine/scene/scene.h"\n',
        "reference/backend.h": '#include "engine/scene/scene.h"\n',
        "reference/plumb.cpp": '#include "engine/simulation/simulation.h"\n',
        "scenarios/fall.cpp": '#include <cmath>\n#include "reference/backend.h"\n',
        "harness/run.h": '#include "reference/backend.h"\n',
        "app/main.cpp": '#include "harness/run.h"\n',
    }
    bad = [
        ("engine/simulation/simulation.cpp", '#include "reference/backend.h"\n'),
        ("engine/scene/scene.cpp", '#include "engine/simulation/simulation.h"\n'),
        ("engine/scene/more.h", ' # include "engine/simulation/simulation.h"\n'),
        ("engine/math/more.h", '#include "engine/scene/scene.h"\n'),
        ("scenarios/spin.cpp", '#include "engine/simulation/simulation.h"\n'),
        ("scenarios/spin.cpp", '#include "harness/run.h"\n'),
        ("reference/other.cpp", '#include "harness/run.h"\n'),
        ("harness/run.cpp", '#include "app/main.cpp"\n'),
        ("app/other.cpp", '#include "run.h"\n'),
        ("demos/core/other.cpp", '#include "harness/run.h"\n'),
    ]
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)

        def write(path, text):
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text, encoding="utf-8")

        for path, text in good.items():
            write(path, text)
        assert wrong_includes(root) == [], wrong_includes(root)
        assert cycles(engine_graph(root)) == []
        for path, text in bad:
            write(path, text)
            assert len(wrong_includes(root)) == 1, f"not seen: {path}: {text}"
            (root / path).unlink()
        write("engine/world/step/a.h", '#include "engine/world/world_data.h"\n')
        write("engine/world/world_data.h", "")
        assert cycles(engine_graph(root)) == []
        write("engine/world/state/b.cpp", '#include "engine/world/step/a.h"\n')
        assert wrong_includes(root) == []
        assert len(cycles(engine_graph(root))) == 1
    print(f"{len(bad)} wrong includes and a cycle were seen")


def main(arguments):
    if arguments == ["--self-test"]:
        self_test()
        return 0
    if len(arguments) == 2 and arguments[0] == "--graph":
        for folder, edges in sorted(engine_graph(pathlib.Path(arguments[1])).items()):
            print(f"{folder} -> {' '.join(sorted(edges)) or '(nothing)'}")
        return 0
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    root = pathlib.Path(arguments[0])
    problems = wrong_includes(root) + cycles(engine_graph(root))
    for problem in problems:
        print(problem)
    count = sum(1 for _ in sources(root))
    print(f"{count} files, {len(problems)} problems")
    return 1 if problems or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
