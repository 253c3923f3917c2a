#!/usr/bin/env python3
"""Checks what libplumb.so exports: the functions that plumb.h declares, and nothing else.

    check_symbols.py HEADER LIBRARY LIST   exit 1 on a difference; LIST has what the version before exported
    check_symbols.py --write HEADER LIST   writes the list anew: a symbol that leaves it breaks programs
    check_symbols.py --self-test
"""

import pathlib
import re
import subprocess
import sys

DECLARED = re.compile(r"PLUMB_API\b[^;(]*?\b(plumb_\w+)\(", re.S)


def declared(header):
    return set(DECLARED.findall(header))


def exported(library):
    """Defined dynamic symbols, without the names of versions."""
    lines = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    return {line.split()[-1].split("@")[0] for line in lines.splitlines()}


def problems(header, symbols, listed):
    for name in sorted(header - symbols):
        yield f"{name} is declared and not exported"
    for name in sorted(symbols - header):
        yield f"{name} is exported and not declared"
    for name in sorted(listed - symbols):
        yield f"{name} was exported before: programs that call it no longer start"
    for name in sorted(symbols - listed):
        yield f"{name} is not listed; write the list anew with --write"


def main():
    if sys.argv[1:] == ["--self-test"]:
        assert declared("PLUMB_API plumb_vec2 plumb_a(int b);\nPLUMB_API const char* plumb_c(void);") == {"plumb_a", "plumb_c"}
        assert list(problems({"a"}, {"a"}, {"a"})) == []
        assert len(list(problems({"a"}, {"b"}, {"c"}))) == 4
        return
    if sys.argv[1] == "--write":
        names = sorted(declared(pathlib.Path(sys.argv[2]).read_text()))
        pathlib.Path(sys.argv[3]).write_text("".join(f"{name}\n" for name in names))
        return
    header, library, listed = sys.argv[1:]
    found = list(problems(declared(pathlib.Path(header).read_text()), exported(library),
                          set(pathlib.Path(listed).read_text().split())))
    print("\n".join(found) or "the library exports what its header declares")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
