#!/usr/bin/env python3
"""Holds docs/course against what it quotes.

usage: check_pages.py ROOT | --output ROOT PLUMB STUDENT | --figures ROOT BUILD | --self-test

A ```cpp block names its file (`path` in the text before it) and stands there word for word, but for how far it is
indented; files that a page links to exist; checks and milestones are there by the names that a page gives them, and no
check is left out. --output: what the page says that `plumb check` prints. --figures: figures/make.py draws these figures.
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap

LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)\s]*)?\)")
NAMED = re.compile(r"`([\w/]+\.(?:h|cpp))`")
CHECK = re.compile(r'\{"(\w+)",\s*"[^"]+",\s*(?:k\w+|"(?:[^"\\]|\\.)*"),\s*\w+(?:,\s*false)?\}')
ROW = re.compile(r"^\| `(\w+)` \|", re.M)
MILESTONE = re.compile(r"`(\w+)\.(\w+)`")
SOURCES = ["bouncing_ball", "cannonballs", "circle_collisions", "rotation_and_boxes", "constraints_and_ragdoll"]


def cpp_blocks(page):
    """(line number, file named before it or None, text) of each ```cpp block."""
    last_text, start, lines = "", 0, None
    for number, line in enumerate(page.split("\n"), 1):
        if lines is not None:
            if line == "```":
                name = NAMED.search(last_text)
                yield start, name and name.group(1), "\n".join(lines)
                lines, last_text = None, ""
            else:
                lines.append(line)
        elif line == "```cpp":
            start, lines = number, []
        elif line.strip():
            last_text = line


def stands_in(block, source):
    """Whether the lines of `block` follow each other in `source`, indented alike."""
    wanted = textwrap.dedent(block).split("\n")
    lines = source.split("\n")
    for first in range(len(lines) - len(wanted) + 1):
        if textwrap.dedent("\n".join(lines[first:first + len(wanted)])).split("\n") == wanted:
            return True
    return False


def check_page(root, path, tests):
    name, page = path.relative_to(root).as_posix(), path.read_text()
    for line, file, text in cpp_blocks(page):
        if not file or not (root / file).exists():
            yield f"{name}:{line}: names no file that is there"
        elif not stands_in(text, (root / file).read_text()):
            yield f"{name}:{line}: does not stand in {file}"
    for target in LINK.findall(page):
        if "://" not in target and not (path.parent / target).exists():
            yield f"{name}: {target} is not there"
    for suite, test in MILESTONE.findall(page.partition("## Milestones")[2]):
        if not re.search(rf"TEST(?:_P|_F)?\({suite}, {test}\)", tests):
            yield f"{name}: tests/demos has no {suite}.{test}"


def check(root):
    pages = sorted((root / "docs/course").glob("*.md"))
    tests = "".join(path.read_text() for path in (root / "tests/demos").glob("*.cpp"))
    for path in pages:
        yield from check_page(root, path, tests)
    chapters = [path for path in pages if path.name[0].isdigit()]
    if len(chapters) != len(SOURCES):
        yield f"{len(chapters)} chapters, not {len(SOURCES)}"
    for path, source in zip(chapters, SOURCES):
        there = CHECK.findall((root / f"harness/course/{source}.cpp").read_text())
        said = ROW.findall(path.read_text().partition("## Checks")[2])
        if there != said or not there:
            yield f"{path.name}: the checks are {', '.join(there)}, the page has {', '.join(said)}"


def check_output(root, plumb, student):
    page = (root / "docs/course/README.md").read_text()
    # Fences in pairs: the end of a block in a language is no beginning.
    blocks = re.finditer(r"^```(\w*)\n(.*?)^```$", page, flags=re.M | re.S)
    said = next(block[2] for block in blocks if not block[1])
    printed = subprocess.run([plumb, "check", "--chapter", "2", "--", student, "explicit_euler"], capture_output=True,
                             text=True, timeout=50).stdout
    if printed != said:
        yield f"docs/course/README.md says that plumb check prints\n{said}but it prints\n{printed}"


def check_figures(root, build):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, root / "docs/course/figures/make.py", build, folder], check=True, timeout=100)
        drawn = sorted(pathlib.Path(folder).glob("*.svg"))
        for path in drawn:
            kept = root / "docs/course/figures" / path.name
            if not kept.exists() or kept.read_text() != path.read_text():
                yield f"docs/course/figures/{path.name} is another one now: run docs/course/figures/make.py and look at it"
        if not drawn:
            yield "no figures were drawn"


def self_test():
    source = "void f() {\n  a();\n  if (b)\n    c();\n}\n"
    cases = [("  a();\n  if (b)\n    c();", True), ("a();\nif (b)\n  c();", True), ("a();\nif (b)\nc();", False),
             ("a();\nc();", False), ("if (b)\n  d();", False)]
    wrong = [f"stands_in({block!r}) is not {right}" for block, right in cases if stands_in(block, source) != right]
    blocks = list(cpp_blocks("In `engine/a.h`:\n\n```cpp\nx\n```\n\n```cpp\ny\n```\n"))
    if blocks != [(3, "engine/a.h", "x"), (7, None, "y")]:
        wrong.append(f"blocks are {blocks}")
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "engine").mkdir()
        (root / "engine/a.h").write_text(source)
        page = root / "page.md"
        page.write_text("`engine/a.h`:\n\n```cpp\na();\n```\n\n```cpp\nz();\n```\n[x](gone.png)\n## Milestones\n`A.B` `A.C`\n")
        found = list(check_page(root, page, "TEST_P(A, B)"))
        if len(found) != 3:
            wrong.append(f"faults are {found}")
    return wrong


def main():
    arguments = sys.argv[1:]
    if arguments == ["--self-test"]:
        faults = self_test()
    elif len(arguments) == 4 and arguments[0] == "--output":
        faults = list(check_output(pathlib.Path(arguments[1]), *arguments[2:]))
    elif len(arguments) == 3 and arguments[0] == "--figures":
        faults = list(check_figures(pathlib.Path(arguments[1]), arguments[2]))
    elif len(arguments) == 1:
        faults = list(check(pathlib.Path(arguments[0])))
    else:
        sys.exit(__doc__)
    print("\n".join(faults) if faults else "the course and what it quotes agree")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
