#!/usr/bin/env python3
"""Plans, does and gathers units with the program itself, and does to them what happens on clusters.

    cluster_test.py PROGRAM CHECKOUT TEST    one test, see those below; exit 77 where what it needs is not installed
"""

import ctypes
import json
import os
import pathlib
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

PROGRAM, CHECKOUT = sys.argv[1], pathlib.Path(sys.argv[2])
QUICK = ["--calibration", "0.01"]
SKIPPED = 77
# Small scenes without costs: their results are the same bits wherever they run.
SMALL = ["compare", "free_fall", "elastic_collision", "--engine", "plumb,plumb-float", "--no-cost"]


def plumb(*words, code=0, cwd=None, limit=None, program=PROGRAM):
    """Runs plumb, which has to end with `code` (None: any). `limit`: bytes of the largest file it may write."""
    def before():
        if limit is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    run = subprocess.run([program, *map(str, words)], capture_output=True, text=True, cwd=cwd, preexec_fn=before)
    if code is not None:
        assert run.returncode == code, f"{words}: exit code {run.returncode}\n{run.stdout}\n{run.stderr}"
    return run


def start(*words):
    return subprocess.Popen([PROGRAM, *map(str, words)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def rows_of(folder, file="results.jsonl"):
    """Results without what differs from run to run: the time of day, and how long it took."""
    rows = []
    for line in (pathlib.Path(folder) / file).read_text().splitlines():
        row = json.loads(line)
        for name in ("environment", "cost", "seconds", "engine_seconds", "memory"):
            row.pop(name, None)
        if row.get("kind") != "environment":
            rows.append(json.dumps(row))
    return rows


def local(folder, *words):
    """What the command itself gives, on this machine, in one go."""
    plumb(*words, "--no-report", "--out", folder)
    return rows_of(folder)


def unpacked(path):
    """Text of a unit's file, which zstd may have compressed."""
    path = pathlib.Path(path)
    if path.exists():
        return path.read_text()
    packed = path.with_name(path.name + ".zst").read_bytes()
    zstd = ctypes.CDLL("libzstd.so.1")
    zstd.ZSTD_decompress.restype = zstd.ZSTD_getFrameContentSize.restype = ctypes.c_ulonglong
    size = zstd.ZSTD_getFrameContentSize(packed, ctypes.c_size_t(len(packed)))
    out = ctypes.create_string_buffer(size)
    assert zstd.ZSTD_decompress(out, ctypes.c_size_t(size), packed, ctypes.c_size_t(len(packed))) == size
    return out.raw[:size].decode()


def make_plain(work, number):
    """Replaces a unit's compressed results by plain ones, as a plumb without zstd leaves them."""
    unit = pathlib.Path(work) / "done" / f"{number:05}"
    text = unpacked(unit / "results.jsonl")
    (unit / "results.jsonl.zst").unlink(missing_ok=True)
    (unit / "results.jsonl").write_text(text)
    facts = json.loads((unit / "unit.json").read_text())
    facts["bytes"].pop("results.jsonl.zst", None)
    facts["bytes"]["results.jsonl"] = (unit / "results.jsonl").stat().st_size
    (unit / "unit.json").write_text(json.dumps(facts))
    return unit / "results.jsonl"


def entries(folder):
    return sorted(path.name for path in pathlib.Path(folder).iterdir())


def units_of(work):
    return [json.loads(line) for line in (pathlib.Path(work) / "units.jsonl").read_text().splitlines()]


def rows_of_nothing(work):
    """Files of results that units have left."""
    return [path for path in (pathlib.Path(work) / "done").rglob("results.jsonl*")]


def state(work):
    return json.loads(plumb("status", work, "--format", "json").stdout)


def units_give_what_the_command_gives(tmp):
    work = tmp / "work"
    plumb("plan", work, "--unit-seconds", "0", *SMALL)
    units = [json.loads(line) for line in (work / "units.jsonl").read_text().splitlines()]
    assert len(units) > 4 and [unit["unit"] for unit in units] == list(range(1, len(units) + 1)), units
    assert all(unit["seconds"] > 0 for unit in units)
    plumb("gather", work, "--out", tmp / "none", code=1)
    assert "not started" in plumb("status", work).stdout
    plumb("work", work, "--unit", 2, *QUICK)
    assert "before" in plumb("work", work, "--unit", 2, *QUICK).stdout, "a unit that is done is not done again"
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
            assert "1 units go on" in plumb("plan", tmp / name, "--next").stdout
            assert not [unit for unit in units_of(tmp / name)[:-1] if unit["cost"]] and units_of(tmp / name)[-1]["cost"]
            plumb("work", tmp / name, "--all", *QUICK)
            # On a busy machine it may be measured again, but the search is not gone on from twice.
            assert "go on" not in plumb("plan", tmp / name, "--next", code=None).stdout.replace("0 units go on", "")
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
    assert "is of another sweep" in plumb("sweep", "free_fall/vacuum", "--jobs", 2, "--out", tmp / "out", code=2).stderr
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
    assert "others used the machine during: 1; " in text, text
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


def killed_at_any_instant_nothing_is_lost(tmp, kills=25):
    work = tmp / "work"
    plumb("plan", work, "--unit-seconds", "0", *SMALL)
    random.seed(39)
    how = ["--all", *QUICK, "--attempts", "1000"]
    for _ in range(kills):
        workers = [start("work", work, *how) for _ in range(2)]
        time.sleep(random.uniform(0, 0.8))
        for worker in workers:
            worker.kill()
            worker.wait()
        for number in entries(work / "done"):
            unit = json.loads((work / "done" / number / "unit.json").read_text())
            for name, size in unit["bytes"].items():
                assert (work / "done" / number / name).stat().st_size == size, (number, name)
    plumb("work", work, *how)
    gathered = json.loads(plumb("gather", work, "--out", tmp / "out", "--no-report", "--format", "json").stdout)
    assert gathered["cut_short"] == gathered["twice"] == 0 and not gathered["damaged"], gathered
    assert rows_of(tmp / "out") == local(tmp / "local", *SMALL)
    assert entries(work / "doing") == entries(work / "claims") == [], (entries(work / "doing"), entries(work / "claims"))


def a_gathering_that_is_killed_leaves_whole_results(tmp, kills=15):
    work = tmp / "work"
    plumb("plan", work, *SMALL)
    plumb("work", work, "--all", *QUICK)
    plumb("gather", work, "--out", tmp / "out", "--no-report")
    rows = rows_of(tmp / "out")
    for _ in range(kills):
        gathering = start("gather", work, "--out", tmp / "out")
        time.sleep(random.uniform(0, 0.3))
        gathering.kill()
        gathering.wait()
        assert rows_of(tmp / "out") == rows


def a_full_disk_is_said_and_loses_nothing(tmp):
    work = tmp / "work"
    plumb("plan", work, "--unit-seconds", "0", *SMALL)
    run = plumb("work", work, "--unit", 1, *QUICK, limit=1500, code=1)
    assert "disk full" in run.stderr, run.stderr
    assert entries(work / "done") == [] and state(work)["failed"] == {"disk full": [1]}
    assert "failed, disk full: 1 (" in plumb("status", work).stdout
    plumb("work", work, "--all", *QUICK)
    assert state(work)["failed"] == {}, "a unit that is done has not failed"
    plumb("gather", work, "--out", tmp / "out")
    before = rows_of(tmp / "out")
    run = plumb("gather", work, "--out", tmp / "out", limit=1500, code=2)
    assert "File too large" in run.stderr, run.stderr
    assert rows_of(tmp / "out") == before, "what was there stays"
    assert not [name for name in entries(tmp / "out") if name.endswith(".new")]


def a_disk_without_room_for_anything_ends_the_worker(tmp):
    small = tmp / "small"
    small.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=48k", "tmpfs", small], capture_output=True).returncode != 0:
        sys.exit(SKIPPED)  # only root may
    try:
        work = small / "work"
        plumb("plan", work, "--unit-seconds", "0", *SMALL)
        run = plumb("work", work, "--all", *QUICK, code=2)
        assert "No space left on device" in run.stderr, run.stderr
        assert 0 < state(work)["done"] < state(work)["units"]
        subprocess.run(["mount", "-o", "remount,size=8m", small], check=True)
        plumb("work", work, "--all", *QUICK, "--attempts", "99")
        plumb("gather", work, "--out", tmp / "out", "--no-report")
    finally:
        subprocess.run(["umount", small], check=True)
    assert rows_of(tmp / "out") == local(tmp / "local", *SMALL)


def gatherings_at_once_give_whole_results(tmp):
    work = tmp / "work"
    plumb("plan", work, "--unit-seconds", "0", *SMALL)
    worker = start("work", work, "--all", *QUICK)
    seen = []
    while worker.poll() is None:
        gatherings = [start("gather", work, "--out", tmp / "out", "--no-report") for _ in range(3)]
        for gathering in gatherings:
            assert gathering.wait() in (0, 1)
        if (tmp / "out/results.jsonl").exists():
            seen.append(len(rows_of(tmp / "out")))
    assert seen == sorted(seen), "later results have what earlier ones had"
    plumb("gather", work, "--out", tmp / "out", "--no-report")
    assert rows_of(tmp / "out") == local(tmp / "local", *SMALL)


def what_is_done_twice_counts_once(tmp):
    work = tmp / "work"
    plumb("plan", work, "--unit-seconds", "0", "compare", "free_fall", *SMALL[3:])
    both = [start("work", work, "--unit", 1, *QUICK) for _ in range(4)]
    assert [one.wait() for one in both] == [0, 0, 0, 0]
    assert entries(work / "done") == ["00001"] and entries(work / "doing") == []
    # The same runs in another unit.
    plumb("plan", work, "compare", "free_fall", *SMALL[3:])
    plumb("work", work, "--all", *QUICK)
    text = plumb("gather", work, "--out", tmp / "out", "--no-report").stdout
    count = len(rows_of(tmp / "out"))
    assert f"{count} runs done twice, counted once" in text and "differ" not in text, text
    # A machine that computes something else is told.
    path = make_plain(work, 1)
    path.write_text(re.sub(r'("position_error":)[-0-9.e]+', r"\1 0.5", path.read_text(), count=1))
    text = plumb("gather", work, "--out", tmp / "out", "--no-report", code=1).stdout
    assert "1 differ" in text, text


def claims_of_the_dead_expire_whatever_the_clocks_say(tmp):
    work = tmp / "work"
    plumb("plan", work, "--unit-seconds", "1e9", *SMALL)
    claim = work / "claims/00001"
    foreign = json.dumps({"nonce": "1", "host": "elsewhere", "boot": "another", "names": "", "process": 1, "began": "1"})
    how = ["--next", *QUICK, "--expiry", "3"]

    def claimed(age):
        claim.write_text(foreign + "\n")
        os.utime(claim, (time.time() - age, time.time() - age))

    claimed(0)
    plumb("work", work, *how, code=3)
    assert state(work)["running"] == [1]
    claimed(-86400)  # its clock is a day fast
    plumb("work", work, *how, code=3)
    time.sleep(3.5)
    plumb("work", work, *how)
    shutil.rmtree(work / "done/00001")
    claimed(100)
    plumb("work", work, *how)
    assert entries(work / "claims") == []
    # A worker renews its claim: it outlives its expiry.
    plumb("plan", tmp / "long", "hunt", "star", "--minutes", "0.12")
    worker = start("work", tmp / "long", "--unit", 1, *QUICK, "--expiry", "2")
    for _ in range(200):
        if (tmp / "long/claims/00001").exists():
            break
        time.sleep(0.05)
    time.sleep(4)
    assert 1 in json.loads(plumb("status", tmp / "long", "--expiry", "2", "--format", "json").stdout)["running"]
    worker.send_signal(signal.SIGTERM)
    assert worker.wait() == 130
    assert state(tmp / "long")["free"][0] == 1, "an interrupted unit is free again"


def another_program_is_refused(tmp):
    work = tmp / "work"
    plumb("plan", work, *SMALL)
    # With the programs of engines beside it, so that the program's own file is all that differs.
    other = tmp / "bin" / pathlib.Path(PROGRAM).name
    other.parent.mkdir()
    for path in pathlib.Path(PROGRAM).parent.glob("plumb*"):
        shutil.copy(path, other.parent)
    with other.open("ab") as file:
        file.write(b"\0")
    for words in (["work", work, "--next"], ["submit", work, "--on", "local"], ["plan", work, *SMALL]):
        run = plumb(*words, code=2, program=str(other))
        assert "hash is" in run.stderr and "another program" in run.stderr and PROGRAM in run.stderr, run.stderr
    assert entries(work / "done") == []


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


def damaged_units_are_said_and_done_again(tmp):
    work = tmp / "work"
    plumb("plan", work, "--unit-seconds", "0", *SMALL)
    plumb("work", work, "--all", *QUICK)
    path = make_plain(work, 1)
    whole = path.read_bytes()
    path.write_bytes(whole[:-40])
    run = plumb("gather", work, "--out", tmp / "out", "--no-report", code=1)
    assert "1 last line cut short, left out" in run.stdout and "damaged: 1 (" in run.stdout, run.stdout
    assert len(rows_of(tmp / "out")) == len(local(tmp / "local", *SMALL)) - 1
    plumb("work", work, "--unit", 1, "--again", *QUICK)
    plumb("gather", work, "--out", tmp / "out", "--no-report")
    assert rows_of(tmp / "out") == rows_of(tmp / "local")


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


def main():
    test = globals()[sys.argv[3]]
    with tempfile.TemporaryDirectory(prefix="plumb-cluster-") as name:
        test(pathlib.Path(name))


if __name__ == "__main__":
    main()
