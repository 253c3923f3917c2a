#!/usr/bin/env python3
"""Replays the units of a folder of work on clusters that are not there: speed-up, and what is lost at the end.

    simulate.py FOLDER [NODES ...]    prints a line for each number of nodes (1, 10, 100, 1000)
    simulate.py --self-test

Units take the time that they took, each and its calibration; nodes take the longest estimate that is free, as `plumb work`
does. One node in a hundred runs at half speed. Prints what the units share alone, and what sharing them finer or coarser gives.
"""

import heapq
import json
import pathlib
import random
import sys

CALIBRATION = 1.0  # s
SLOW = 0.01  # share of nodes at half speed


def replay(units, nodes, seed=1):
    """Time until all are done, and busy seconds; units: (estimate, seconds)."""
    chance = random.Random(seed)
    speed = [0.5 if chance.random() < SLOW else 1.0 for _ in range(nodes)]
    free = [(0.0, node) for node in range(nodes)]
    busy = 0.0
    last = 0.0
    for _, seconds in sorted(units, key=lambda unit: -unit[0]):
        now, node = heapq.heappop(free)
        took = (seconds + CALIBRATION) / speed[node]
        busy += took
        last = max(last, now + took)
        heapq.heappush(free, (now + took, node))
    return last, busy


def load(folder):
    units = []
    for line in (pathlib.Path(folder) / "units.jsonl").read_text().splitlines():
        unit = json.loads(line)
        done = pathlib.Path(folder) / f"done/{unit['unit']:05}/unit.json"
        if done.exists():
            units.append((unit["seconds"], json.loads(done.read_text())["seconds"]))
    return units


def table(units, counts):
    alone = sum(seconds for _, seconds in units)
    print(f"{len(units)} units, {alone:.0f} s of work, the longest {max(seconds for _, seconds in units):.1f} s")
    print(f"{'nodes':>6} {'s':>8} {'speed-up':>9} {'busy':>6}")
    for nodes in counts:
        last, busy = replay(units, nodes)
        print(f"{nodes:>6} {last:>8.1f} {alone / last:>9.1f} {busy / (nodes * last):>6.0%}")


def self_test():
    same = [(1.0, 9.0)] * 1000
    assert replay(same, 1, seed=1)[0] == 10000.0, "one after the other, each with its calibration"
    last, _ = replay(same, 1000)
    assert last == 20.0, "a slow node is waited for"
    assert replay([(5, 99.0)] + same, 10)[0] < 1.25 * 10100 / 10, "the longest comes first"


def main(arguments):
    if arguments == ["--self-test"]:
        return self_test()
    if not arguments:
        sys.exit(__doc__)
    table(load(arguments[0]), [int(text) for text in arguments[1:]] or [1, 10, 100, 1000])


if __name__ == "__main__":
    main(sys.argv[1:])
