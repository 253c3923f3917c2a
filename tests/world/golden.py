#!/usr/bin/env python3
"""Rewrites tests/world/golden_hashes.txt with the hashes that the tests print now.

Example: tests/world/golden.py --why "joints are solved with the contacts that press on them"
"""
import argparse
import pathlib
import re
import subprocess
import sys

FILE = pathlib.Path(__file__).with_name("golden_hashes.txt")
PROGRAMS = ("test_world", "test_simulation")
FOUND = re.compile(r"golden hash: (\S+) 0x([0-9a-f]+)")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--why", required=True, help="why the motion changed, for the lines that are rewritten")
    parser.add_argument("--build", default=FILE.parents[2] / "build/release", type=pathlib.Path,
                        help="the build folder, whose tests are up to date (build/release)")
    options = parser.parse_args()
    found, failed = {}, False
    for name in PROGRAMS:
        program = options.build / "tests" / name
        if not program.exists():
            sys.exit(f"golden.py: {program} is not there; build it first: ./plumb test -N")
        run = subprocess.run([program, "--gtest_filter=*OneHashEverywhere*"], capture_output=True, text=True)
        here = dict(FOUND.findall(run.stdout))
        if run.returncode != 0 and not here:
            print(run.stdout + run.stderr)
            failed = True
        found |= here
    if failed or not found:
        print("nothing was written" if failed else "all hashes are as they were")
        return int(failed)
    lines = []
    for line in FILE.read_text().splitlines():
        name = line.split()[0]
        if name in found:
            line = f"{name:19} 0x{int(found.pop(name), 16):016x}  {options.why}"
            print(line)
        lines.append(line)
    for name, value in found.items():
        lines.append(f"{name:19} 0x{int(value, 16):016x}  {options.why}")
        print(lines[-1])
    FILE.write_text("\n".join(lines) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
