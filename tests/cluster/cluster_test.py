#!/usr/bin/env python3
"""Plans, does and gathers units with the program itself, here and by schedulers.

    cluster_test.py PROGRAM CHECKOUT TEST    one test, see those below; exit 77 where what it needs is not installed
"""

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True

from commands import (  # noqa: E402
    CHECKOUT, PROGRAM, QUICK, SKIPPED, SMALL, entries, local, plumb, rows_of, rows_of_nothing, run_test, start,
    state, units_of, unpacked)


def units_give_what_the_command_gives(tmp):
    work = tmp / "work"
    plumb("plan", work, "--unit-seconds", "0", *SMALL)
    units = [json.loads(line) for line in (work / "units.jsonl").read_text().splitlines()]
    assert len(units) > 4 and [unit["unit"] for unit in units] == list(range(1, len(units) + 1)), units
    assert all(unit["seconds"] > 0 for unit in units)
    plumb("gather", work, "--out", tmp / "none", code=1)
    assert "not started" in plumb("status", work).stdout
    plumb("work", work, "--unit", 2, *QUICK)
    assert "already done" in plumb("work", work, "--unit", 2, *QUICK).stdout, "a unit that is done is not done again"
    plumb("work", work, "--next", *QUICK)
    plumb("work", work, "--all", *QUICK)
    plumb("work", work, "--next", *QUICK, code=3)
    done = json.loads((work / "done/00002/unit.json").read_text())
    assert done["machine"]["kind"] and done["before"]["median_ms"] > 0 and done["after"]["repetitions"] >= 3, done
    gathered = plumb("gather", work, "--out", tmp / "out").stdout
    assert f"{len(units)} of {len(units)} units are done" in gathered, gathered
    assert rows_of(tmp / "out") == local(tmp / "local", *SMALL), "the same rows in the same order"
    assert (tmp / "out/report.html").stat().st_size > 100_000
    assert entries(work / "doing") == entries(work / "claims") == entries(work / "failed") == []
    assert state(work)["done"] == len(units)
    # Planning on adds what is not there.
    text = plumb("plan", work, "--unit-seconds", "0", "compare", "free_fall", "pendulum_chain[2]", *SMALL[3:]).stdout
    assert re.search(r"; 1 of them are new", text), text


def every_command_can_be_planned(tmp):
    for name, words, file in (
            ("stress", ["stress", "mass_ratio_stack", "--quick", "--engine", "plumb-float,box2d"], "stress.jsonl"),
            ("thresholds", ["thresholds", "ramp_friction", "--digits", "1", "--engine", "plumb-float"], "thresholds.jsonl"),
            ("sweep", ["sweep", "free_fall/vacuum", "--engine", "plumb,box2d", "--budget", "4"], "results.jsonl")):
        plumb("plan", tmp / name, *words)
        plumb("work", tmp / name, "--all", *QUICK)
        if name == "sweep":
            # The costs of all engines take turns in a unit that goes on from the search of each.
            assert not rows_of_nothing(tmp / name), "no result before costs are measured"
            assert "1 units continue" in plumb("plan", tmp / name, "--next").stdout
            assert not [unit for unit in units_of(tmp / name)[:-1] if unit["cost"]] and units_of(tmp / name)[-1]["cost"]
            plumb("work", tmp / name, "--all", *QUICK)
            # On a busy machine it may be measured again, but the search is not gone on from twice.
            assert "units continue" not in plumb("plan", tmp / name, "--next", code=None).stdout.replace("0 units continue", "")
            plumb("work", tmp / name, "--all", *QUICK)
        plumb("gather", tmp / name, "--out", tmp / f"{name}-out", code=0)
        assert rows_of(tmp / f"{name}-out", file), name
    # A map is the same cells, in another order.
    plumb("stress", "mass_ratio_stack", "--quick", "--engine", "plumb-float,box2d", "--out", tmp / "here")
    assert sorted(rows_of(tmp / "stress-out", "stress.jsonl")) == sorted(rows_of(tmp / "here", "stress.jsonl"))
    plumb("plan", tmp / "again", "--earlier", tmp / "stress", "stress", "mass_ratio_stack", "--quick", "--engine",
          "plumb-float,box2d")
    assert json.loads((tmp / "again/units.jsonl").read_text().splitlines()[0])["measured"], "an estimate from results"
    plumb("plan", tmp / "hunt", "--seeds", "2", "hunt", "star", "--scenes", "2", "--seed", "7")
    plumb("work", tmp / "hunt", "--all", *QUICK)
    plumb("gather", tmp / "hunt", "--out", tmp / "hunted")
    assert json.loads((tmp / "hunted/gathered.json").read_text())["hunt"]["scenes"] == 4
    plumb("plan", tmp / "reality", "reality", "--published", "--engine", "plumb")
    plumb("work", tmp / "reality", "--all", *QUICK)
    plumb("gather", tmp / "reality", "--out", tmp / "real")
    assert json.loads((tmp / "real/published.json").read_text())
    scene = tmp / "mine.json"
    scene.write_text(plumb("scene", "free_fall/vacuum").stdout)
    plumb("plan", tmp / "file", "sweep", scene, "--engine", "plumb", "--budget", "2", "--duration", "1")
    scene.unlink()
    plumb("work", tmp / "file", "--unit", 1, *QUICK)


def a_sweep_of_several_cores_goes_on_where_it_was(tmp):
    command = ["sweep", "free_fall/drag", "elastic_collision/oblique", "--engine", "plumb,box2d", "--budget", "12", "--jobs", "2",
               "--out", tmp / "out"]
    work = tmp / "out/work"
    running = start(*command)
    for _ in range(600):
        if (work / "done").exists() and entries(work / "done"):
            break
        time.sleep(0.02)
    running.kill()
    running.wait()
    kept = {name: (work / "done" / name / "unit.json").read_text() for name in entries(work / "done")}
    assert kept
    text = plumb(*command).stdout
    for part in ("free_fall/drag", "elastic_collision/oblique", "overall", "front of"):
        assert part in text, text
    for name, facts in kept.items():
        assert (work / "done" / name / "unit.json").read_text() == facts, "what was done is not done again"
    rows = [json.loads(line) for line in (tmp / "out/results.jsonl").read_text().splitlines()]
    assert {row["engine"] for row in rows if row["cost"]} == {"plumb", "box2d"}
    keys = [json.dumps([row["label"], row["engine"], row["asked"]]) for row in rows]
    assert len(keys) == len(set(keys))
    # Each row is the row of a sweep in one process.
    plumb("sweep", *command[1:-4], "--out", tmp / "one")
    one = {json.dumps([row["label"], row["engine"], row["asked"]]): row for row in
           map(json.loads, (tmp / "one/results.jsonl").read_text().splitlines())}
    both = [(row, one[key]) for key, row in zip(keys, rows) if key in one]
    # How many settings each had time for depends on the machine.
    assert both and all(row["metrics"] == other["metrics"] for row, other in both), len(both)
    before = (tmp / "out/results.jsonl").read_text()
    plumb(*command)
    assert (tmp / "out/results.jsonl").read_text() == before
    assert "belongs to another sweep" in plumb("sweep", "free_fall/vacuum", "--jobs", 2, "--out", tmp / "out", code=2).stderr
    plumb("sweep", "free_fall/vacuum", "--jobs", 2, "--explore", 1, "--out", tmp / "new", code=2)


def disturb(work, number, factor):
    """Makes the calibrations of a unit those of a machine that others used by `factor` after it."""
    path = pathlib.Path(work) / "done" / f"{number:05}" / "unit.json"
    facts = json.loads(path.read_text())
    facts["before"] = {"fastest_ms": 2.0, "median_ms": 2.0, "repetitions": 3}
    facts["after"] = {"fastest_ms": 2.0 * factor, "median_ms": 2.0 * factor, "repetitions": 3}
    path.write_text(json.dumps(facts))


def disturbed_units_are_measured_again(tmp):
    work = tmp / "work"
    plumb("plan", work, "--unit-seconds", "0", "compare", "free_fall/vacuum", "free_fall/drag", "--engine", "plumb-float")
    plumb("work", work, "--all", *QUICK)
    for number, factor in ((1, 1.5), (2, 1.0)):
        disturb(work, number, factor)
    text = plumb("status", work).stdout
    assert "disturbed by other programs: 1; " in text, text
    assert "1 are measured again" in plumb("plan", work, "--next").stdout
    again = units_of(work)[-1]
    host = json.loads((work / "done/00001/unit.json").read_text())["machine"]["host"]
    assert len(units_of(work)) == 3 and again["repeats"] == 1 and again["avoid"] == [host], again
    plumb("plan", work, "--next", code=3)  # it is planned already
    # Another is at work, perhaps on another host, to which it is left.
    (work / "claims/00099").write_text("{}\n")
    plumb("work", work, "--next", *QUICK, code=3)
    (work / "claims/00099").unlink()
    plumb("work", work, "--all", *QUICK)
    disturb(work, 3, 1.3)
    plumb("plan", work, "--next")
    plumb("work", work, "--all", *QUICK)
    disturb(work, 4, 1.4)
    plumb("plan", work, "--next", code=3)  # three times are enough
    plumb("gather", work, "--out", tmp / "out", "--no-report")

    def gathered(label):
        return [json.loads(line)["cost"]["each_ns_per_step"] for line in (tmp / "out/results.jsonl").read_text().splitlines()
                if json.loads(line)["label"] == label]

    def measured(number):
        return [json.loads(line)["cost"]["each_ns_per_step"] for line in
                unpacked(work / "done" / f"{number:05}" / "results.jsonl").splitlines()]
    assert gathered("free_fall/vacuum") == measured(3), "the least disturbed of three"
    assert json.loads((tmp / "out/gathered.json").read_text())["noisy"] == [1]
    disturb(work, 4, 1.0)
    plumb("gather", work, "--out", tmp / "out", "--no-report")
    assert gathered("free_fall/vacuum") == measured(4) and gathered("free_fall/drag") == measured(2)
    assert json.loads((tmp / "out/gathered.json").read_text())["noisy"] == []
    # Without costs nothing is disturbed.
    plumb("plan", tmp / "errors", *SMALL)
    plumb("work", tmp / "errors", "--all", *QUICK)
    disturb(tmp / "errors", 1, 2.0)
    plumb("plan", tmp / "errors", "--next", code=3)


def units_are_compressed(tmp):
    work = tmp / "work"
    plumb("plan", work, *SMALL)
    plumb("work", work, "--all", *QUICK)
    packed = work / "done/00001/results.jsonl.zst"
    if not packed.exists():
        assert (work / "done/00001/results.jsonl").exists()
        sys.exit(SKIPPED)  # built without zstd
    text = unpacked(work / "done/00001/results.jsonl")
    assert len(text) > 4 * packed.stat().st_size, (len(text), packed.stat().st_size)
    plumb("gather", work, "--out", tmp / "out", "--no-report")
    assert rows_of(tmp / "out") == local(tmp / "local", *SMALL)
    whole = packed.read_bytes()
    for broken in (whole[:-40], whole[:len(whole) // 2] + bytes([whole[len(whole) // 2] ^ 0xff]) + whole[len(whole) // 2 + 1:], b""):
        packed.write_bytes(broken)
        run = plumb("gather", work, "--out", tmp / "out", "--no-report", code=1)
        assert "damaged: 1 (" in run.stdout, run.stdout
    plumb("work", work, "--unit", 1, "--again", *QUICK)
    plumb("gather", work, "--out", tmp / "out", "--no-report")
    assert rows_of(tmp / "out") == rows_of(tmp / "local")


def what_cannot_be_planned_is_refused(tmp):
    for words in (["list"], ["compare", "fre_fall"], ["compare", "--colour"], ["stress", "--list"], [],
                  ["compare", "free_fall", "--out", "x"]):
        run = plumb("plan", tmp / "work", *words, code=2)
        assert run.stderr.startswith("plumb: ") and run.stderr.count("\n") == 1, run.stderr
    plumb("plan", tmp / "work", "--next", code=2)
    plumb("plan", tmp / "work", "--next", *SMALL, code=2)
    for option in ("--unit-seconds=nan", "--unit-seconds=-1", "--seeds=0", "--earlier=nowhere"):
        plumb("plan", tmp / "work", option, *SMALL, code=2)
    assert not (tmp / "work/plan.json").exists()
    plumb("work", tmp / "work", "--next", code=2)
    plumb("plan", tmp / "work", *SMALL)
    plumb("work", tmp / "work", code=2)
    plumb("work", tmp / "work", "--unit", 99, code=2)


def costs_of_different_machines_do_not_meet(tmp):
    work = tmp / "work"
    plumb("plan", work, "--by-engine", "compare", "free_fall/vacuum", "--engine", "plumb,plumb-float,box2d")
    for unit, kind in ((1, "old"), (2, "old"), (3, "new")):
        plumb("work", work, "--unit", unit, *QUICK, "--kind", kind)
    text = plumb("gather", work, "--out", tmp / "out").stdout
    assert "2 units on old" in text and "1 unit on new" in text, text
    front = plumb("front", tmp / "out").stdout
    assert "the costs of 1 runs are left out: measured on another kind of machine" in front, front
    assert front.index("on old:") < front.index("on new:"), "fronts of each kind, that with the most costs first"
    assert {row.split(",")[1] for row in plumb("front", tmp / "out", "--format", "csv").stdout.splitlines()[1:]} == {
        "plumb", "plumb-float"}, "the front of the kind of machine with the most costs"
    assert {row.split(",")[1] for row in plumb("front", tmp / "out", "--format", "csv", "--machine",
                                               "new").stdout.splitlines()[1:]} == {"box2d"}
    plumb("front", tmp / "out", "--machine", "newest", code=2)
    report = (tmp / "out/report.html").read_text()
    assert '"cost_left_out":true' in report
    # Nor do old and new.
    path = tmp / "out/results.jsonl"
    (tmp / "later").mkdir()
    (tmp / "later/results.jsonl").write_text(path.read_text().replace('"machine":"old"', '"machine":"newest"'))
    text = plumb("compare", tmp / "out", tmp / "later").stdout
    assert "3 left out: measured on different kinds of machine" in text, text


def local_submission_does_all_and_gathers(tmp):
    work = tmp / "work"
    plumb("plan", work, "--unit-seconds", "0", "compare", "free_fall", *SMALL[3:])
    assert "2 x: plumb work" in plumb("submit", work, "--on", "local", "--jobs", "2", "--dry-run").stdout
    text = plumb("submit", work, "--on", "local", "--jobs", "2").stdout
    assert "units are done" in text and (work / "results/report.html").exists(), text


def gnu_parallel_goes_on_where_it_was(tmp):
    if shutil.which("parallel") is None:
        sys.exit(SKIPPED)
    work = tmp / "work"
    plumb("plan", work, "--unit-seconds", "0", *SMALL)
    plumb("submit", work, "--on", "parallel", "--dry-run", "--out", tmp / "out")
    script = work / "submit/001/parallel.sh"
    for text in ("--joblog", "--resume", "work"):
        assert text in script.read_text()
    run = subprocess.Popen(["bash", script], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    for _ in range(600):
        if entries(work / "done"):
            break
        time.sleep(0.05)
    os.killpg(run.pid, signal.SIGKILL)
    run.wait()
    run = subprocess.run(["bash", script], capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr
    assert rows_of(tmp / "out") == local(tmp / "local", *SMALL)


def slurm_scripts_are_read_by_a_shell(tmp):
    """Runs them with an sbatch that does the tasks at once. Slurm itself is not started by a test."""
    work = tmp / "a folder's work"
    plumb("plan", work, "--unit-seconds", "0", *SMALL)
    plumb("submit", work, "--on", "slurm", "--nodes", "3", "--partition", "short", "--dry-run", "--out", tmp / "out")
    place = work / "submit/001"
    text = (place / "array.sh").read_text()
    count = len((work / "units.jsonl").read_text().splitlines())
    for line in (f"--array=1-{count}%3", "--requeue", "--partition=short", "--mem=4096M", "--time=0-00:0"):
        assert line in text, text
    commands = tmp / "bin"
    commands.mkdir()
    sbatch = commands / "sbatch"
    sbatch.write_text(f"""#!/bin/bash
set -e
script=${{@: -1}}
if [[ $script == array.sh ]]; then
  for i in $(seq 1 {count}); do SLURM_ARRAY_TASK_ID=$i SLURM_RESTART_COUNT=9 bash $script; done >&2
  echo "17;here"
else
  [[ $* == *--dependency=afterany:17* ]]
  bash $script >&2
  echo 18
fi
""")
    sbatch.chmod(0o755)
    run = subprocess.run([PROGRAM, "submit", work, "--on", "slurm", "--out", tmp / "out"], capture_output=True, text=True,
                         env={**os.environ, "PATH": f"{commands}:{os.environ['PATH']}"})
    assert run.returncode == 0 and "array 17, gathering 18" in run.stdout, run.stdout + run.stderr
    assert rows_of(tmp / "out") == local(tmp / "local", *SMALL)


def the_walk_through_runs(tmp):
    page = (CHECKOUT / "docs/cluster.md").read_text()
    block = re.search(r"## Walk-through\n.*?```sh\n(.*?)```", page, re.DOTALL).group(1)
    (tmp / "plumb").symlink_to(PROGRAM)
    for line in block.splitlines():
        command = line.split("#")[0].strip()
        if command:
            run = subprocess.run(["bash", "-c", command], capture_output=True, text=True, cwd=tmp)
            assert run.returncode == 0, f"{command}\n{run.stdout}{run.stderr}"
    assert (tmp / "results/report.html").exists()


if __name__ == "__main__":
    run_test(globals())
