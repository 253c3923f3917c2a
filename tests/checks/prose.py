#!/usr/bin/env python3
"""Checks that comments say what the code does: none starts with What, Whether, Where or Who (CONTRIBUTING.md).

    prose.py CHECKOUT     prints each comment that does, exit 1 if there are any
    prose.py --self-test  shows that comments of each form are found
"""

import pathlib
import re
import sys

FOLDERS = ("engine", "reference", "harness", "scenarios", "extremes", "app", "demos", "bench", "bindings", "tests")
LINE = re.compile(r"^\s*//[/!]?<?\s*(?P<text>.*)$")
TRAILING = re.compile(r"[;,{})]\s*//[/!]?<?\s*(?P<text>.*)$")
MARKER = re.compile(r"(What|Whether|Where|Who)\b", re.IGNORECASE)


def marked(text):
    """Yields the number and text of each comment that starts with a marker. Lines that continue a comment may."""
    in_comment = False
    for number, line in enumerate(text.splitlines(), 1):
        own = LINE.match(line)
        comment = own or TRAILING.search(line)
        if comment and not (own and in_comment) and MARKER.match(comment["text"]):
            yield number, line.strip()
        in_comment = own is not None and own["text"] != ""


def self_test():
    found = ["/// Whether it is open.", "int a;  ///< what it is\n", "//\n// Who comes first.", "}  // where it ends"]
    left = ["/// Returns true if open.", "/// Says\n/// what it is.", "int what;  ///< m", 'f("// what");']
    assert all(len(list(marked(text))) == 1 for text in found), found
    assert not any(list(marked(text)) for text in left), left


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1])
    hits = 0
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            for number, line in marked(path.read_text()):
                print(f"{path.relative_to(root)}:{number}: {line}")
                hits += 1
    if hits:
        sys.exit(f"{hits} comments start with What, Whether, Where or Who; start with a verb: Returns, Computes, Updates")


if __name__ == "__main__":
    main()
