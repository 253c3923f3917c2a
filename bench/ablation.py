#!/usr/bin/env python3
"""Leaves out the special mechanisms of the world's step, one at a time, and prints what changes without each.

    cmake --preset release -B build/ablation -DPLUMB_ABLATION=ON && cmake --build build/ablation
    bench/ablation.py build/ablation                            all mechanisms, all parts: hours
    bench/ablation.py build/ablation --only lifts,joint_gaps    two of them
    bench/ablation.py build/ablation --part stress,world        without fields and instructions
    bench/ablation.py build/ablation --table                    print the table of the results so far

Before single mechanisms the program leaves out all of them at once, and then all except those that others belong to (as
jointed islands, of which many are details). Cells and tests that do not change there are taken not to change without one
mechanism, and are not run again (--no-screen runs them).

Parts: the cells of `plumb stress` with the default setting of plumb (`stress`), the tests of test_world (`world`), the
quality of field scenes (`field`), and the instructions per step of field scenes under callgrind (`instructions`). Each is
compared with a run without any change. Cells and tests that take longer than --longest seconds there are left out.
Results are kept in --out, a part of a mechanism per file, so that the same command continues an interrupted run.
docs/decisions/ablation.md has the table and what follows from it.
"""

import argparse
import collections
import concurrent.futures
import csv
import io
import json
import os
import pathlib
import re
import subprocess
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
NAMES = ROOT / "engine/world/ablation/ablation.cpp"
BASE, ALL, DETAILS = "none", "all", "details"
# Mechanisms without which others do nothing.
WHOLES = {"direct_islands", "jointed_islands", "hinge_trees", "joint_gaps", "impacts_in_flight", "lasting_contacts"}
PARTS = ["stress", "world", "field", "instructions"]
# Field scenes of --quick: those that show overlaps, joint gaps, heights or speeds, and those whose instructions count.
FIELD = ["large_pyramid", "joint_grid", "tumbler", "smash", "spinner", "washer", "rain", "junkyard", "compounds", "chain_10",
         "pyramid_10"]
COUNTED = ["large_pyramid", "joint_grid", "tumbler", "rain", "junkyard"]
FIELD_STEPS, COUNTED_STEPS = 300, 30
# Columns of quality, with the ratio from which a scene counts as changed: piles are chaotic, and their largest overlap is
# another one after any change.
QUALITY = {"deepest_m": 2, "mean_overlap_m": 1.25, "height": 1.001, "worst_joint_m": 2, "mean_joint_m": 1.25,
           "worst_limit_rad": 2, "escaped": 2}
CELL_SECONDS = 10  # limit of a cell

# The code that a mechanism consists of: file (below engine/world) and functions; without functions the whole file.
CODE = {
    "slender_islands": {"islands/direct_islands.cpp": ["choose_slender"]},
    "direct_islands": {"joint_solver/direct_rows.cpp": [], "joint_solver/direct_rows.h": [],
                       "islands/direct_islands.cpp": ["flies", "add_rows", "solve_by_iterations", "current_separation",
                                                      "for_each_direct", "solve_direct_islands"]},
    "flying_stacks": {"islands/direct_islands.cpp": ["flies"]},
    "jointed_islands": {"islands/jointed_islands.cpp": [], "islands/jointed_islands.h": [], "islands/island_rows.h": [],
                        "islands/friction_cones.h": [], "islands/energy_bounds.h": [], "islands/position_corrections.h": [],
                        "islands/direct_islands.cpp": ["choose_jointed", "order_jointed", "keep_loads", "hand_over_joints",
                                                       "hand_over_unselected"]},
    "hinge_trees": {"islands/hinge_trees.cpp": [], "islands/hinge_trees.h": [], "joint_solver/hinge_tree.cpp": [],
                    "joint_solver/hinge_tree.h": [], "joint_solver/hinge_tree_energy.h": []},
    "link_inertia": {"joint_solver/hinge_tree.cpp": ["find_required_inertias", "damp"],
                     "joint_solver/hinge_tree_energy.h": []},
    "tree_energy": {"joint_solver/hinge_tree_energy.h": []},
    "divided_substeps": {"islands/jointed_islands.cpp": ["for_each_gap", "drift_of", "step_in_parts", "subdivide_substep"]},
    "kept_impulses": {"islands/energy_bounds.h": ["gains_by_taking_back", "keep_impulses"]},
    "rigid_groups": {"islands/island_links.h": ["find_rigid_groups"]},
    "driver_budget": {"islands/energy_bounds.h": ["budget_of"], "islands/direct_islands.cpp": ["keep_loads"]},
    "yielding_contacts": {"islands/island_rows.h": ["soften"]},
    "mass_limits": {"islands/position_corrections.h": ["limit_mass_ratio"]},
    "shift_work": {"islands/position_corrections.h": ["compensate_shift_work"]},
    "penetration_corrections": {"islands/position_corrections.h": ["correct_penetrations"]},
    "handing_over": {"islands/direct_islands.cpp": ["hand_over_joints", "hand_over_unselected", "hand_over_all"],
                     "islands/jointed_islands.cpp": ["work_on_own_response", "update_warm_start_fraction"]},
    "balanced_breaks": {"state/joints.cpp": ["keep_balanced_impulses"]},
    "joint_gaps": {"islands/joint_gaps.cpp": [], "islands/joint_gaps.h": [], "joint_solver/joint_opening.h": [],
                   "joint_solver/joint_set_gaps.cpp": []},
    "carried_impulses": {"islands/joint_gaps.cpp": ["carry_impulses", "load_imbalance"]},
    "angular_limits": {"joint_solver/joint_set_limits.cpp": [], "solvers/soft_step.cpp": ["project_angular_limits"]},
    "contact_gains": {"islands/contact_gains.cpp": [], "islands/contact_gains.h": []},
    "load_estimates": {"step/contact_update.h": ["update_load_estimate"]},
    "substep_growth": {"step/step.cpp": ["substeps_of"]},
    "impulse_memory": {"state/impulse_memory.cpp": [], "state/impulse_memory.h": []},
    "kinematic_ramps": {"integration/free_motion.cpp": ["ramp_kinematic_velocities", "end_kinematic_ramps", "displacement_by",
                                                        "fraction_within"]},
    "disc_normals": {"solvers/restitution.cpp": ["is_centred_circle", "predict_circle_normal"],
                     "contact_solver/restitution_contacts.cpp": ["update_masses", "update_circle_normal"]},
    "kept_closed": {"solvers/restitution.cpp": ["any_without_restitution", "keep_closed"]},
    "turning_contacts": {"solvers/turning_contacts.cpp": [], "solvers/turning_contacts.h": []},
    "riding_contacts": {"step/common_rotation.h": [], "step/lasting_contact.cpp": ["rebuild_rotating_contact"]},
    "lasting_contacts": {"step/lasting_contact.cpp": ["contact_at_middle", "lasting_contact", "may_arrive",
                                                      "rebuild_lasting_contact", "arriving_contact"]},
    "segments_ahead": {"step/lasting_contact.cpp": ["contact_after", "segment_ahead"],
                       "step/contact_update.h": ["follows_surface"]},
    "turned_manifolds": {"step/recycled_manifold.h": ["rotate_manifold"]},
    "internal_edges": {"state/internal_edges.cpp": [], "state/internal_edges.h": []},
    "impacts_in_flight": {"step/expected_impacts.cpp": [], "step/expected_impacts.h": [], "continuous/rebound.cpp": [],
                          "contact_solver/contact_impact.cpp": [], "contact_solver/contact_impact.h": []},
    "landings": {"step/expected_impacts.cpp": ["moves_far"]},
    "simultaneous_impacts": {"step/expected_impacts.cpp": ["time_of_contact", "assign_simultaneous_impacts"]},
    "separating_faces": {"step/separating_face.h": []},
    "open_joints": {"step/open_joints.cpp": [], "step/open_joints.h": []},
    "self_overlap_pass": {"step/pairs.cpp": ["is_mostly_apart", "mark_self_overlaps"]},
    "shared_searches": {"step/pairs.cpp": ["may_share_search", "collect_group", "find_group_pairs"]},
    "common_motion": {"continuous/common_motion.cpp": [], "continuous/common_motion.h": [],
                      "continuous/continuous.cpp": ["continue_together"]},
    "lifts": {"continuous/swept_pair.cpp": ["LiftAxes", "may_lift", "lift_off"], "continuous/continuous.cpp": ["lift"]},
    "joined_stops": {"continuous/joined_stops.cpp": ["find_joint_corrections", "anchor_constraint_of"]},
    "remaining_work": {"continuous/joined_stops.cpp": ["twice_work_on", "remove_remaining_work"]},
    "long_searches": {},
    "swept_bounds": {"continuous/swept_bound.h": [], "continuous/swept_pair.cpp": ["is_clear"]},
}


def mechanisms():
    """Returns the names that the program knows, in their order."""
    table = re.search(r"kMechanisms\[\] = \{(.*?)\};", NAMES.read_text(), re.S)
    return re.findall(r'"(\w+)"', table.group(1))


def lines_of(mechanism):
    """Returns the lines of a mechanism's functions and files, with their comments. Its calls and members are not counted."""
    total = 0
    for file, functions in CODE.get(mechanism, {}).items():
        lines = (ROOT / "engine/world" / file).read_text().splitlines()
        if not functions:
            total += len(lines)
            continue
        for name in functions:
            found = 0
            for i, line in enumerate(lines):
                indent = len(line) - len(line.lstrip())
                if not re.match(rf"\s*(?!return|if|for|//|template|using)[\w\[\]<>:,&*\s]*\b{name}\b( \{{|\()", line) \
                        or line.rstrip().endswith(";"):
                    continue
                end = next((k for k in range(i, len(lines)) if re.match(rf"^ {{{indent}}}\}}", lines[k])), None)
                if line.rstrip().endswith("}"):
                    end = i
                if end is None:
                    continue
                first = i
                while first > 0 and re.match(rf"^ {{{indent}}}(//|template)", lines[first - 1]):
                    first -= 1
                found += end - first + 1
            if found == 0:
                sys.exit(f"{file} has no function {name}: correct the list of {mechanism}")
            total += found
    return total


def environment(mechanism):
    out = dict(os.environ)
    out.pop("PLUMB_ABLATE", None)
    if mechanism != BASE:
        out["PLUMB_ABLATE"] = mechanism
        if mechanism in (ALL, DETAILS):
            out["PLUMB_ABLATE"] = ",".join(name for name in mechanisms() if mechanism == ALL or name not in WHOLES)
    return out


def run(command, mechanism, seconds, folder=None):
    """Returns the output and the exit code of a program; None as the code if it does not end in time."""
    try:
        ran = subprocess.run(command, env=environment(mechanism), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                             errors="replace", timeout=seconds, cwd=folder, check=False)
        return ran.stdout, ran.returncode
    except subprocess.TimeoutExpired as late:
        text = late.stdout or b""
        return text.decode(errors="replace") if isinstance(text, bytes) else text, None


def run_tests(command, mechanism, patience):
    """Runs tests until one crashes or takes longer than its patience, s. Returns name -> [passed, seconds]."""
    out, running = {}, None
    with subprocess.Popen(command, env=environment(mechanism), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace", bufsize=1) as program:
        watch = None
        for line in program.stdout:
            if begun := re.match(r"\[ RUN +\] (\S+)", line):
                running = begun[1]
                if watch:
                    watch.cancel()
                watch = threading.Timer(patience.get(running, 600), program.kill)
                watch.start()
            elif ended := re.match(r"\[ +(OK|FAILED|SKIPPED) +\] ([\w/]+\.[\w/]+).*\((\d+) ms\)$", line):
                out[ended[2]] = [ended[1] != "FAILED", int(ended[3]) / 1000]
                running = None
        if watch:
            watch.cancel()
    if running:
        out[running] = [False, 0]
    return out


class Study:
    def __init__(self, options):
        self.build, self.out, self.longest = options.build.resolve(), options.out.resolve(), options.longest
        self.screens = not options.no_screen
        self.skipped = set(options.skip.read_text().splitlines()) if options.skip else set()

    def file(self, mechanism, part):
        return self.out / mechanism / f"{part}.json"

    def result(self, mechanism, part):
        file = self.file(mechanism, part)
        return json.loads(file.read_text()) if file.exists() else None

    def measure(self, mechanism, part):
        if self.result(mechanism, part) is not None:
            return
        (self.out / mechanism).mkdir(parents=True, exist_ok=True)
        begin = time.time()
        found = getattr(self, part)(mechanism)
        partial = self.file(mechanism, part).with_suffix(".tmp")
        partial.write_text(json.dumps(found, indent=1))
        partial.rename(self.file(mechanism, part))
        print(f"{time.strftime('%H:%M:%S')} {mechanism} {part}: {time.time() - begin:.0f} s", file=sys.stderr, flush=True)

    def worth_running(self, mechanism, part, kind, names):
        """Returns the cells or tests that change if many mechanisms are left out."""
        screens = [self.result(each, part) for each in ((ALL, DETAILS) if mechanism in WHOLES else (DETAILS,))]
        if not self.screens or mechanism in (BASE, ALL, DETAILS) or None in screens:
            return set(names)
        base = self.result(BASE, part)[kind]
        return {name for name in names if any(base[name][0] != each[kind].get(name, [None])[0] for each in screens)}

    # ---- Stress: family|value -> [outcome, seconds, reason]

    def stress(self, mechanism):
        base = self.result(BASE, "stress")
        folder = self.out / mechanism / "stress"
        journal = folder / "stress.jsonl"
        program = str(self.build / "bin/plumb")
        command = [program, "stress", "--engine", "plumb", "--jobs", "1", "--timeout", str(CELL_SECONDS), "--out",
                   str(folder)]
        if not journal.exists():
            # Cells that are left out are entered as if they had run. A first cell shows the form of a line.
            first = self.out / "form" / "stress.jsonl"
            if not first.exists():
                run([program, "stress", "dt_fall", "--quick", "--engine", "plumb", "--jobs", "1", "--timeout",
                     str(CELL_SECONDS), "--out", str(first.parent)], BASE, 600)
            lines = [json.loads(line) for line in first.read_text().splitlines()]
            form = next(line for line in lines if line["kind"] == "cell")
            folder.mkdir(parents=True, exist_ok=True)
            known = self.worth_running(mechanism, "stress", "cells", base["cells"]) if base else None
            with journal.open("w") as to:
                to.write(json.dumps(lines[0]) + "\n")
                for family, values in self.families(program):
                    for value in values:
                        for setting in ("default", "careful", "direct"):
                            name = f"{family}|{value:g}"
                            runs = name not in self.skipped if known is None else name in known
                            if setting == "default" and runs:
                                continue
                            to.write(json.dumps({**form, "family": family, "value": value, "setting": setting,
                                                 "outcome": "skipped", "seconds": 0}) + "\n")
        run(command, mechanism, 7200)
        cells = dict(base["cells"]) if base else {}
        for line in journal.read_text().splitlines():
            cell = json.loads(line)
            if cell["kind"] == "cell" and cell["setting"] == "default" and cell["outcome"] != "skipped":
                if base is None and cell["seconds"] > self.longest:
                    continue
                cells[f"{cell['family']}|{cell['value']:g}"] = [cell["outcome"], cell["seconds"], cell["reason"]]
        return {"cells": cells}

    @staticmethod
    def families(program):
        """Returns each family with the values of its axis."""
        text, _ = run([program, "stress", "--list"], BASE, 60)
        out, lines = [], text.splitlines()
        for i, line in enumerate(lines):
            if not re.match(r"\w+$", line):
                continue
            values = ""
            for at in range(i + 1, len(lines)):
                if lines[at].startswith("  right is:") or not lines[at].startswith("  "):
                    break
                values = values + " " + lines[at].strip() if values or ":" in lines[at] else ""
            numbers = re.findall(r"(?:^|\s)(-?[\d.]+(?:e[+-]?\d+)?)(?:/([\d.]+))?(?=\s|$)", values.split(":", 1)[-1])
            out.append((line, [float(a) / float(b or 1) for a, b in numbers]))
        return out

    # ---- Tests of the world: name -> [ok, seconds]

    def world(self, mechanism):
        base = self.result(BASE, "world")
        program = str(self.build / "tests/test_world")
        listed, _ = run([program, "--gtest_list_tests"], BASE, 60)
        names, suite = [], ""
        for line in listed.splitlines():
            name = line.split("#")[0].rstrip()
            if not line.startswith(" "):
                suite = name
            elif not suite.startswith("Ablation"):
                names.append(suite + name.strip())
        tests = {}
        if base is not None:
            tests = {name: [True, 0] for name, found in base["tests"].items() if found[0]}
            names = [name for name in names if name in self.worth_running(mechanism, "world", "tests", tests)]
        left = [name for name in names if name not in self.skipped]
        so_far = self.out / mechanism / "world.so_far.json"
        if so_far.exists():
            done = json.loads(so_far.read_text())
            tests.update(done)
            left = [name for name in left if name not in done]
        done = {}
        while left:
            some, left = left[:200], left[200:]
            patience = {name: 600 if base is None else 10 + 5 * base["tests"][name][1] for name in some}
            done.update(run_tests([program, "--gtest_filter=" + ":".join(some)], mechanism, patience))
            missing = [name for name in some if name not in done]
            if missing and len(missing) == len(some):  # not even one began
                done[missing.pop(0)] = [False, 0]
            left = missing + left
            so_far.write_text(json.dumps({**(json.loads(so_far.read_text()) if so_far.exists() else {}), **done}))
        tests.update(done)
        so_far.unlink(missing_ok=True)
        if base is None:
            tests = {name: found for name, found in tests.items() if found[1] <= self.longest}
        return {"tests": tests}

    # ---- Field: scene -> column -> value

    def field(self, mechanism):
        command = [str(self.build / "bin/plumb_field"), *FIELD, "--engine", "plumb", "--quick", "--steps", str(FIELD_STEPS),
                   "--repeat", "1", "--format", "csv"]
        text, code = run(command, mechanism, 600)
        rows = csv.DictReader(io.StringIO(text[text.find("scene,engine"):]))
        return {"code": code, "scenes": {row["scene"]: {name: float(row[name] or "nan") for name in QUALITY} for row in rows}}

    def instructions(self, mechanism):
        sys.path.insert(0, str(ROOT / "bench/field"))
        import instructions  # bench/field/instructions.py
        instructions.STEPS = COUNTED_STEPS
        os.environ.pop("PLUMB_ABLATE", None)
        os.environ.update({name: text for name, text in environment(mechanism).items() if name == "PLUMB_ABLATE"})
        try:
            return {"scenes": {scene: instructions.count(str(self.build / "bin/plumb_field"), scene)["sum"]
                               for scene in COUNTED}}
        finally:
            os.environ.pop("PLUMB_ABLATE", None)

    # ---- The table

    def changed_cells(self, mechanism):
        base, now = self.result(BASE, "stress"), self.result(mechanism, "stress")
        if base is None or now is None:
            return None
        lost, won = [], []
        for cell, (outcome, *_) in base["cells"].items():
            other = now["cells"].get(cell, ["?"])[0]
            if (outcome == "ok") != (other == "ok"):
                (lost if outcome == "ok" else won).append(cell.replace("|", " ") + f": {other}")
        return lost, won

    def failed_tests(self, mechanism):
        base, now = self.result(BASE, "world"), self.result(mechanism, "world")
        if base is None or now is None:
            return None
        return [name for name, (ok, *_) in base["tests"].items() if ok and not now["tests"].get(name, [True])[0]]

    def changed_scenes(self, mechanism):
        base, now = self.result(BASE, "field"), self.result(mechanism, "field")
        if base is None or now is None:
            return None
        if now["scenes"] == base["scenes"]:
            return ["same"]
        out = []
        for scene, columns in base["scenes"].items():
            if scene not in now["scenes"]:
                out.append(f"{scene} fails")
                continue
            for name, value in columns.items():
                low, high = sorted((abs(value), abs(now["scenes"][scene][name])))
                if high > QUALITY[name] * low and high > 1e-6:
                    out.append(f"{scene}: {name.rsplit('_', 1)[0]} {value:.2g} -> {now['scenes'][scene][name]:.2g}")
        return out

    def cost(self, mechanism):
        base, now = self.result(BASE, "instructions"), self.result(mechanism, "instructions")
        if base is None or now is None:
            return None
        return [f"{scene} {100 * (now['scenes'][scene] / count - 1):+.1f} %" for scene, count in base["scenes"].items()
                if abs(now["scenes"][scene] / count - 1) >= 0.005]

    def table(self):
        def of(found):
            return "not measured" if found is None else ", ".join(found) or "none"

        def grouped(found, key):
            """Returns each group of a list of names with its size, largest first."""
            groups = collections.Counter(key(name) for name in found)
            return [f"{group} ({count})" if count > 1 else group for group, count in groups.most_common()]

        print("| mechanism | lines | stress cells lost | cells won | tests of the world that fail | field scenes | instructions |")
        print("|---|--:|---|---|---|---|---|")
        for name in [ALL, DETAILS, *mechanisms()]:
            if not (self.out / name).exists():
                continue
            lost, won = self.changed_cells(name) or (None, None)
            tests = self.failed_tests(name)
            if tests is not None:
                proper = [test for test in tests if "Hash" not in test]
                tests = grouped(proper, lambda test: re.split(r"[/.]", test)[0])
                if proper and len(proper) <= 2:
                    tests = sorted({re.sub(r"/\d", "", test) for test in proper})
            print(f"| {name} | {lines_of(name) or 'few'} | "
                  f"{of(lost and grouped(lost, lambda cell: cell.split()[0]) if lost else lost)} | {of(won)} | {of(tests)} | "
                  f"{of(self.changed_scenes(name))} | {of(self.cost(name))} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, help="folder of a build with PLUMB_ABLATION")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("ablation"), help="folder of the results (ablation)")
    parser.add_argument("--only", default="", help="mechanisms, separated by commas")
    parser.add_argument("--part", default=",".join(PARTS), help="parts, separated by commas")
    parser.add_argument("--longest", type=float, default=3, help="s that a cell or test may take without any change (3)")
    parser.add_argument("--skip", type=pathlib.Path, help="file with the names of further cells (family|value) and tests to omit")
    parser.add_argument("--no-screen", action="store_true", help="run what does not change if all mechanisms are left out, too")
    parser.add_argument("--jobs", type=int, default=1, help="mechanisms at the same time (1)")
    parser.add_argument("--table", action="store_true", help="print the table of the results so far")
    options = parser.parse_args()
    study = Study(options)
    known = mechanisms()
    chosen = [name for name in options.only.split(",") if name] or known
    parts = options.part.split(",")
    for name in chosen:
        if name not in known:
            sys.exit(f"there is no mechanism '{name}': {', '.join(known)}")
    for part in parts:
        if part not in PARTS:
            sys.exit(f"there is no part '{part}': {', '.join(PARTS)}")
    if options.table:
        study.table()
        return
    tried = ["chain_10", "--quick", "--engine", "plumb", "--steps", "10", "--repeat", "1"]
    text, _ = run([str(options.build / "bin/plumb_field"), *tried], "unknown", 60)
    if "PLUMB_ABLATE" not in text:
        sys.exit(f"{options.build} has no switches: configure it with -DPLUMB_ABLATION=ON")
    for part in parts:
        study.measure(BASE, part)
        if not options.no_screen:
            study.measure(ALL, part)
            study.measure(DETAILS, part)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for part in parts:
            list(pool.map(lambda name: study.measure(name, part), chosen))
    study.table()


if __name__ == "__main__":
    main()
