#!/usr/bin/env python3
"""Checks that each file which a page names in backticks exists: `engine/world/step/step.cpp`, `step.cpp`, `bounces.*`, `step.{h,cpp}`.

    named_files.py [ROOT]

A name counts if it is the end of a file's path in the tree. Only names of sources are checked (.cpp, .h, .mjs, .sh, .cmake), for other
files are often made by what a page describes. Exit status: 0, or 1 with a line for each that is missing.
"""

import fnmatch
import pathlib
import re
import sys

ENDINGS = r"(?:cpp|h|mjs|sh|cmake|\*|\{[a-z,]+\})"
NAMED = re.compile(rf"`([\w./*{{}},-]+\.{ENDINGS})`")
LEFT_OUT = {"build", ".git", "results", "node_modules"}
# Files that the page's reader writes, or that a program makes, and names that are no files.
MADE = re.compile(r"(^|/)(NAME\w*|my_\w+|dumbbell|ballistic|array|gather|submit|parallel|Bodies|libplumb\.so)\.")


def files_of(root):
    found = []
    for path in root.rglob("*"):
        parts = path.relative_to(root).parts
        if not LEFT_OUT & set(parts) and path.is_file():
            found.append("/" + "/".join(parts))
    return found


def alternatives(name):
    """`step.{h,cpp}` as `step.h` and `step.cpp`."""
    braces = re.search(r"\{([^}]*)\}", name)
    if not braces:
        return [name]
    return [name[:braces.start()] + one + name[braces.end():] for one in braces.group(1).split(",")]


def missing(root):
    files = files_of(root)
    pages = [page for page in [*root.glob("*.md"), *(root / "docs").rglob("*.md")] if page.name != "CHANGELOG.md"]  # history
    for page in sorted(pages):
        for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
            for name in NAMED.findall(line):
                if MADE.search(name):
                    continue
                for one in alternatives(name):
                    if not any(fnmatch.fnmatch(file, f"*/{one.removeprefix('./')}") for file in files):
                        yield f"{page.relative_to(root)}:{number}: `{one}` is not in the tree"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    lines = list(missing(root))
    print("\n".join(lines))
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
