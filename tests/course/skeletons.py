#!/usr/bin/env python3
"""Makes the course's skeletons in Python from the solved engines: each `# gap: TEXT ... # end` becomes a TODO.

usage: skeletons.py STARTERS [--write]    without --write: fails if a skeleton is not what it would be
"""
import pathlib
import re
import sys

GAP = re.compile(r"^( *)# gap: ([^\n]*)\n((?:\1# [^\n]*\n)*?)(?!\1# )((?:[^\n]*\n)*?)\1# end\n", re.M)


def skeleton(solved):
    def cut(found):
        indent, first, more, _ = found.groups()
        return f"{indent}# TODO: {first}\n{more}{indent}pass\n"
    out, count = GAP.subn(cut, solved)
    out = out.replace('.dirname(os.path.dirname(os.path.abspath(__file__))))', '.dirname(os.path.abspath(__file__)))')
    return out.replace(". See docs/course/", ": a skeleton, solved/ has it filled in. See docs/course/", 1), count


def main():
    folder, write = pathlib.Path(sys.argv[1]) / "python", sys.argv[2:] == ["--write"]
    faults = []
    for path in sorted((folder / "solved").glob("chapter?.py")):
        text, count = skeleton(path.read_text())
        if count == 0 or "# gap" in text or "# end" in text:
            faults.append(f"{path.name}: its gaps are not closed, or there are none")
        target = folder / path.name
        if write:
            target.write_text(text)
        elif not target.exists() or target.read_text() != text:
            faults.append(f"{target} is not what its solution makes: run tests/course/skeletons.py {sys.argv[1]} --write")
    print("\n".join(faults) or "skeletons agree with the solved engines")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
