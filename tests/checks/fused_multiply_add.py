#!/usr/bin/env python3
"""Checks by disassembly that no fused multiply-add is in a library or program: a x b + c rounded once gives other
bits than rounded twice, and which of them a compiler picks depends on its version and options.

    fused_multiply_add.py BINARY...                   exit 1 when one is found
    fused_multiply_add.py --self-test COMPILER TEMP   compiles one that has them and shows that it is seen
"""

import pathlib
import platform
import re
import subprocess
import sys

# x86: FMA3 and FMA4, vfmadd213sd, vfnmsubpd, vfmaddsub132ps, ...; Arm: fmadd d0, fmls v0, ...
FUSED = re.compile(r"^(vfn?m(add|sub|addsub|subadd)[0-9]*[ps][sdh]|fn?m(add|sub)|fml[as]l?2?)$")
SYMBOL = re.compile(r"^[0-9a-f]+ <(.+)>:$")
INSTRUCTION = re.compile(r"^ *[0-9a-f]+:\t([a-z0-9.]+)")


def find(binary):
    """(symbol, mnemonic) of each fused multiply-add, and how many instructions were read."""
    found, count, symbol = [], 0, "?"
    command = ["objdump", "--disassemble", "--no-show-raw-insn", "--demangle", "--wide", str(binary)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, errors="replace") as process:
        for line in process.stdout:
            if match := INSTRUCTION.match(line):
                count += 1
                if FUSED.match(match.group(1)):
                    found.append((symbol, match.group(1)))
            elif match := SYMBOL.match(line):
                symbol = match.group(1)
    if process.returncode != 0:
        raise SystemExit(f"objdump failed on {binary}")
    return found, count


def check(binaries):
    bad = 0
    for binary in binaries:
        found, count = find(binary)
        if count == 0:
            print(f"{binary}: no instructions were found in it")
            bad += 1
        for symbol, mnemonic in found:
            print(f"{binary}: {mnemonic} in {symbol}")
        bad += len(found)
        print(f"{binary}: {count} instructions, {len(found)} fused multiply-adds")
    return 1 if bad else 0


def self_test(compiler, folder):
    """The check passes what these options compile, and fails when contraction is allowed."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    source = folder / "fused.cpp"
    source.write_text("double fused(double a, double b, double c) { return a * b + c; }\n"
                      "float negated(float a, float b, float c) { return c - a * b; }\n", encoding="utf-8")
    x86 = platform.machine() in ("x86_64", "AMD64", "i686")
    for options, expected in ((["-ffp-contract=off"], 0), (["-ffp-contract=fast"] + ["-mfma"] * x86, 2)):
        target = folder / "fused.o"
        subprocess.run([compiler, "-O2", *options, "-c", str(source), "-o", str(target)], check=True)
        found, _ = find(target)
        print(f"{' '.join(options)}: {[mnemonic for _, mnemonic in found]}")
        if len(found) != expected:
            raise SystemExit(f"expected {expected}")


def main(arguments):
    if len(arguments) == 3 and arguments[0] == "--self-test":
        self_test(arguments[1], arguments[2])
        return 0
    if not arguments or arguments[0].startswith("-"):
        print(__doc__, file=sys.stderr)
        return 2
    return check(arguments)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
