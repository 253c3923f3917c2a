#!/usr/bin/env python3
"""Does to units what happens on clusters: kills workers, fills disks, sets clocks wrong, damages files.

    failures_test.py PROGRAM CHECKOUT TEST    one test, see those below; exit 77 where what it needs is not installed
"""

import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time

sys.dont_write_bytecode = True

from commands import (  # noqa: E402
    PROGRAM, QUICK, SKIPPED, SMALL, entries, local, make_plain, plumb, rows_of, run_test, start, state)


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
    assert "1 of these differ" in text, text


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


def damaged_units_are_said_and_done_again(tmp):
    work = tmp / "work"
    plumb("plan", work, "--unit-seconds", "0", *SMALL)
    plumb("work", work, "--all", *QUICK)
    path = make_plain(work, 1)
    whole = path.read_bytes()
    path.write_bytes(whole[:-40])
    run = plumb("gather", work, "--out", tmp / "out", "--no-report", code=1)
    assert "1 last line incomplete, left out" in run.stdout and "damaged: 1 (" in run.stdout, run.stdout
    assert len(rows_of(tmp / "out")) == len(local(tmp / "local", *SMALL)) - 1
    plumb("work", work, "--unit", 1, "--again", *QUICK)
    plumb("gather", work, "--out", tmp / "out", "--no-report")
    assert rows_of(tmp / "out") == rows_of(tmp / "local")


if __name__ == "__main__":
    run_test(globals())
