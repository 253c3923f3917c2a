#!/usr/bin/env python3
"""Compiles the public headers as programs see them with every compiler and library at hand: alone and together,
as plain C++20 without extensions, and with a compiler that takes Microsoft's.

    public_headers.py CHECKOUT FOLDER   exit 1 for a header that does not compile, 77 if there is no compiler
    public_headers.py --self-test FOLDER

FOLDER is where the headers are written as an installation has them.
"""

import dataclasses
import pathlib
import shutil
import subprocess
import sys

PLAIN = ["-std=c++20", "-pedantic-errors", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]
MICROSOFT = ["-std=c++20", "-fms-compatibility", "-fms-compatibility-version=19.33", "-fms-extensions",
             "-fdelayed-template-parsing", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]
LIBCXX = ["-stdlib=libc++"]
# Debian has libc++ for WebAssembly beside the one for the machine; that one has no <filesystem>.
WASI = ["--target=wasm32-wasi", "-fexceptions", "-isystem", "/usr/include/wasm32-wasi/c++/v1"]


@dataclasses.dataclass(frozen=True)
class Way:
    """A compiler with its options, and the headers of the language's library that it must have."""

    name: str
    command: list
    alone: bool = False  # each header by itself too
    files: bool = True   # there is <filesystem>


def ways():
    """All that there could be."""
    gcc = shutil.which("g++-12") or shutil.which("g++")
    clang = shutil.which("clang++-16") or shutil.which("clang++")
    if gcc:
        yield Way("g++", [gcc, *PLAIN], alone=True)
    if clang:
        yield Way("clang++", [clang, *PLAIN])
        yield Way("clang++ with libc++", [clang, *PLAIN, *LIBCXX])
        yield Way("clang++ with libc++ for WebAssembly", [clang, *PLAIN, *WASI], files=False)
        yield Way("clang++ as Microsoft's, with libc++", [clang, *MICROSOFT, *LIBCXX])
        yield Way("clang++ as Microsoft's, with libc++ for WebAssembly", [clang, *MICROSOFT, *WASI], files=False)


def compiles(way, text, folder):
    """Returns what the compiler says against a source, or nothing."""
    done = subprocess.run([*way.command, f"-I{folder}", "-x", "c++", "-"], input=text, text=True, capture_output=True)
    return done.stderr or f"exit status {done.returncode}" if done.returncode else ""


def reads_files(header):
    """True if a header, or one that it includes, needs <filesystem>."""
    root = header.parents[0]
    text, seen, open_ = "", set(), [header]
    while open_:
        path = open_.pop()
        if path in seen or not path.exists():
            continue
        seen.add(path)
        text = path.read_text()
        if "#include <filesystem>" in text:
            return True
        open_ += [root / line.split("<plumb/")[1].split(">")[0] for line in text.splitlines()
                  if line.startswith("#include <plumb/")]
    return False


def problems(folder):
    """Yields what does not compile, and at last the number of ways tried."""
    headers = sorted((folder / "plumb").glob("*.h"))
    tried = 0
    for way in ways():
        missing = compiles(way, "#include <atomic>\n#include <string>\n#include <variant>\nstd::string s;\n", folder)
        if missing:
            print(f"left out: {way.name}, whose library is not there")
            continue
        tried += 1
        chosen = [each for each in headers if way.files or not reads_files(each)]
        sources = ["".join(f"#include <plumb/{each.name}>\n" for each in chosen)]
        if way.alone:
            sources += [f"#include <plumb/{each.name}>\n" for each in chosen]
        failed = [said for said in (compiles(way, text, folder) for text in sources) if said]
        for said in failed:
            yield f"{way.name}:\n{said}"
        if not failed:
            print(f"{way.name}: {len(chosen)} headers compile")
    if tried == 0:
        print("there is no compiler that the headers could be tried with")
        sys.exit(77)


def self_test(folder):
    """Plants an extension, a warning and an include that is missing."""
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "plumb").mkdir(parents=True)
    (folder / "plumb/good.h").write_text("#pragma once\n#include <string>\ninline std::string s() { return \"\"; }\n")
    assert not list(problems(folder)), "a good header is refused"
    for bad in ("inline int f(int n) { int a[n]; a[0] = 1; return a[0]; }\n",  # an array of variable length
                "inline int g(int unused) { return 0; }\n",
                "inline std::vector<int> h() { return {}; }\n"):
        (folder / "plumb/bad.h").write_text("#pragma once\n" + bad)
        assert list(problems(folder)), f"not refused: {bad}"
    print("every planted fault was found")


def main():
    if sys.argv[1] == "--self-test":
        return self_test(pathlib.Path(sys.argv[2]))
    checkout, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run(["cmake", f"-DCHECKOUT={checkout}", f"-DTO={folder}", "-P", checkout / "cmake/public_headers.cmake"],
                   check=True)
    found = list(problems(folder))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
