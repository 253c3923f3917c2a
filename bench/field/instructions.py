#!/usr/bin/env python3
"""Counts the instructions per step of six field scenes, by stage, and compares them with bench/field/instructions.txt.
Unlike times, they repeat exactly.

    instructions.py PROGRAM                  compare; exits with 1 if a scene's sum differs by more than 3 %
    instructions.py --why TEXT PROGRAM       write the present counts, with the reason for the change
    instructions.py --markdown PROGRAM       print the table of docs/speed.md

PROGRAM is plumb_field. Scenes have their small size (--quick) and 160 steps, counted by callgrind. Fewer instructions than
in the reference fail as well, because otherwise the same increase would later pass. Counts depend on the compiler and the
processor's vector width, which the reference names; with others, or without valgrind, the exit code is 77.
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

FILE = pathlib.Path(__file__).with_name("instructions.txt")
SCENES = ["large_pyramid", "joint_grid", "tumbler", "spinner", "rain", "junkyard"]
STEPS = 160  # measured; one more warms up. With fewer, no heap has formed yet
TOLERANCE = 0.03
STAGES = {"find_pairs": "broad_phase", "update_contacts": "narrow_phase", "solve_motion": "solver",
          "finalize_bodies": "finalize", "solve_continuous": "continuous", "sleep_islands": "sleep"}
COLUMNS = ["sum", *STAGES.values()]


def inclusive(text):
    """Returns stage -> instructions for the calls from step_world in a callgrind file, and their sum with its own."""
    names, stages, inside, total = {}, dict.fromkeys(COLUMNS, 0), False, 0

    def name_of(field):
        number, _, name = field.partition(" ")
        if name:
            names[number] = name
        return names[number]

    lines = iter(text.splitlines())
    called = None
    for line in lines:
        if line.startswith("fn="):
            inside = "step_world" in name_of(line[3:])
        elif line.startswith("cfn="):
            called = name_of(line[4:])
        elif line.startswith("calls="):
            cost = int(next(lines).split()[1])
            if inside:
                total += cost
                for function, stage in STAGES.items():
                    if f"plumb::{function}<" in called:
                        stages[stage] += cost
        elif inside and re.match(r"[+\-*\d]", line):
            total += int(line.split()[1])
    stages["sum"] = total
    return stages


def count(program, scene):
    with tempfile.TemporaryDirectory(prefix="plumb_instructions") as room:
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={room}/out.%p", "--collect-atstart=no",
                   "--toggle-collect=*plumb::step_world*", program, scene, "--engine", "plumb", "--quick", "--steps", str(STEPS),
                   "--repeat", "1"]
        ran = subprocess.run(command, capture_output=True, text=True, check=False)
        if ran.returncode != 0:
            sys.exit(f"{' '.join(command)}\n{ran.stdout}{ran.stderr}")
        found = [inclusive(file.read_text()) for file in pathlib.Path(room).glob("out.*")]
    stages = max(found, key=lambda each: each["sum"])
    if stages["sum"] == 0:
        sys.exit(f"callgrind counted nothing:\n{ran.stderr}")
    return {stage: round(cost / (STEPS + 1)) for stage, cost in stages.items()}


def built_for(program):
    """Returns the compiler of a program, and the vector registers that its step uses on this machine."""
    comment = subprocess.run(["readelf", "-p", ".comment", program], capture_output=True, text=True, check=False).stdout
    compiler = re.search(r"(GCC: \(.*?\) \S+|clang version \S+)", comment)
    cpu = pathlib.Path("/proc/cpuinfo")
    wide = cpu.exists() and re.search(r"\bavx2\b", cpu.read_text())
    return f"{compiler.group(1) if compiler else 'unknown'}, {'AVX2' if wide else 'no AVX2'}"


def read():
    built, why, counts = "", "", {}
    for line in FILE.read_text().splitlines() if FILE.exists() else []:
        key, _, rest = line.partition(" ")
        if key == "built:":
            built = rest
        elif key == "why:":
            why = rest
        elif key in SCENES:
            counts[key] = dict(zip(COLUMNS, map(int, rest.split())))
    return built, why, counts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--why")
    parser.add_argument("--markdown", action="store_true")
    parser.add_argument("program")
    options = parser.parse_args()
    if not shutil.which("valgrind"):
        print("valgrind is not installed: skipped")
        sys.exit(77)
    built = built_for(options.program)
    reference_built, _, reference = read()
    if not options.why and not options.markdown and built != reference_built:
        print(f"built with {built}, the reference with {reference_built}: skipped")
        sys.exit(77)
    counts, off = {}, []
    form = "| {} |" + " {} |" * len(COLUMNS) if options.markdown else "{:<15}" + "{:>14}" * len(COLUMNS)
    print(form.format("scene", *COLUMNS))
    if options.markdown:
        print("|---|" + "--:|" * len(COLUMNS))
    for scene in SCENES:
        counts[scene] = count(options.program, scene)
        print(form.format(scene, *(f"{counts[scene][column]:,}" for column in COLUMNS)), flush=True)
        if scene in reference:
            change = counts[scene]["sum"] / reference[scene]["sum"] - 1
            if abs(change) > TOLERANCE:
                off.append(f"{scene}: {change:+.1%} of {reference[scene]['sum']:,} instructions a step")
    if options.why:
        lines = ["Instructions a step, written by instructions.py --why: scene, " + ", ".join(COLUMNS), f"built: {built}",
                 f"why: {options.why}"]
        lines += [f"{scene} " + " ".join(str(counts[scene][column]) for column in COLUMNS) for scene in SCENES]
        FILE.write_text("\n".join(lines) + "\n")
    elif off and not options.markdown:
        sys.exit("\n".join(off) + "\nMeant? instructions.py --why TEXT")


if __name__ == "__main__":
    main()
