#!/usr/bin/env python3
"""Replays measured units on clusters that are not there: speed-up, and what is lost at the end.

    simulate.py TIMES [--of SECONDS]       prints a table for 1, 10, 100 and 1,000 nodes, by the length of units
    simulate.py TIMES --picture FILE.svg   draws it
    simulate.py --self-test

TIMES: a folder of work whose units are done, or a file with a line "estimate seconds" for each, s. The work is these pieces again and
again, as of as many settings or seeds, until it is SECONDS long (240,000). Pieces share a unit up to a length, by their estimates, as
`plumb plan --unit-seconds` groups them; 0: each its own. Nodes take the unit with the longest estimate that is free, as `plumb work` does.
Each unit costs the second of its calibration besides; one node in a hundred runs at half speed.
"""

import heapq
import json
import math
import pathlib
import random
import sys

CALIBRATION = 1.0  # s
SLOW = 0.01  # share of nodes at half speed
NODES = (1, 10, 100, 1000)
LENGTHS = (0, 6, 60, 600)  # s of a unit
WORK = 240_000.0  # s


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


def load(path):
    path = pathlib.Path(path)
    if path.is_file():
        lines = [line.split() for line in path.read_text().splitlines() if line and not line.startswith("#")]
        return [(float(estimate), float(seconds)) for estimate, seconds in lines]
    units = []
    for line in (path / "units.jsonl").read_text().splitlines():
        unit = json.loads(line)
        done = path / f"done/{unit['unit']:05}/unit.json"
        if done.exists():
            units.append((unit["seconds"], json.loads(done.read_text())["seconds"]))
    return units


def repeated(pieces, wanted):
    """The pieces as often as makes them `wanted` seconds long."""
    times = max(1, round(wanted / sum(seconds for _, seconds in pieces)))
    return pieces * times


def grouped(pieces, length):
    """Units of pieces that follow each other, up to `length` s by their estimates."""
    units = []
    estimate = seconds = 0.0
    for piece, took in pieces:
        if estimate > 0 and estimate + piece > length:
            units.append((estimate, seconds))
            estimate = seconds = 0.0
        estimate += piece
        seconds += took
    units.append((estimate, seconds))
    return units


def figures(pieces, length, nodes):
    """Speed-up over the work alone, and the share of the nodes' time in which they wait for the last unit."""
    units = grouped(pieces, length)
    last, busy = replay(units, nodes)
    return sum(seconds for _, seconds in units) / last, 1 - busy / (nodes * last)


def table(pieces):
    alone = sum(seconds for _, seconds in pieces)
    print(f"{len(pieces)} pieces, {alone:.0f} s of work, the longest {max(seconds for _, seconds in pieces):.1f} s")
    print("| nodes |" + "".join(f" {length or 'a piece'}{' s' if length else ''} a unit |" for length in LENGTHS))
    print("|---|" + "---|" * len(LENGTHS))
    for nodes in NODES:
        cells = [figures(pieces, length, nodes) for length in LENGTHS]
        print(f"| {nodes:,} |" + "".join(f" {speed:.1f}, {loss:.0%} |" for speed, loss in cells))


def picture(pieces):
    """Speed-up and loss over the number of nodes, a line for each length of units."""
    many = [round(10 ** (i / 6)) for i in range(19)]
    colours = ("#0072b2", "#d55e00", "#009e73", "#b8860b")
    lines = []
    width, height, top, bottom = 300, 220, 34, 40

    def text(x, y, words, anchor="middle", more=""):
        lines.append(f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{more}>{words}</text>')

    def panel(left, title, y_of, ticks):
        def x_of(nodes):
            return left + width * (0 if nodes == 1 else math.log10(nodes)) / 3
        text(left + width / 2, 18, title, more=' font-weight="bold"')
        for nodes in NODES:
            lines.append(f'<path d="M{x_of(nodes):.1f} {top}V{top + height}" stroke="#8886"/>')
            text(x_of(nodes), top + height + 16, f"{nodes:,}")
        text(left + width / 2, top + height + 33, "nodes")
        for value, label in ticks:
            lines.append(f'<path d="M{left} {y_of(value):.1f}H{left + width}" stroke="#8886"/>')
            text(left - 6, y_of(value) + 4, label, "end")
        return x_of

    data = {length: [figures(pieces, length, nodes) for nodes in many] for length in LENGTHS}
    speed_y = lambda speed: top + height * (3 - math.log10(max(speed, 0.1))) / 4
    loss_y = lambda loss: top + height * (1 - loss)
    left = panel(52, "speed-up over one node", speed_y, [(speed, f"{speed:,}") for speed in (0.1, *NODES)])
    lines.append(f'<path d="M{left(1):.1f} {speed_y(1):.1f}L{left(1000):.1f} {speed_y(1000):.1f}" stroke="#888" stroke-dasharray="3 4" fill="none"/>')
    right = panel(430, "time lost, waiting for the last unit", loss_y, [(share, f"{share:.0%}") for share in (0, 0.25, 0.5, 0.75, 1)])
    for colour, length in zip(colours, LENGTHS):
        for x_of, y_of, part in ((left, speed_y, 0), (right, loss_y, 1)):
            points = " ".join(f"{x_of(nodes):.1f},{y_of(one[part]):.1f}" for nodes, one in zip(many, data[length]))
            lines.append(f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>')
    for i, (colour, length) in enumerate(zip(colours, LENGTHS)):
        x = 60 + 170 * i
        lines.append(f'<path d="M{x} {top + height + 54}h24" stroke="{colour}" stroke-width="2"/>')
        text(x + 30, top + height + 58, f"{length} s a unit" if length else "each its own unit", "start")
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 750 {top + height + bottom + 30}" font-family="system-ui, sans-serif" '
            'font-size="12" fill="#777">\n' + "\n".join(lines) + "\n</svg>\n")


def self_test():
    same = [(1.0, 9.0)] * 1000
    assert replay(same, 1, seed=1)[0] == 10000.0, "one after the other, each with its calibration"
    last, _ = replay(same, 1000)
    assert last == 20.0, "a slow node is waited for"
    assert replay([(5, 99.0)] + same, 10)[0] < 1.25 * 10100 / 10, "the longest comes first"
    assert grouped([(1, 2.0), (1, 3.0), (1, 4.0)], 2) == [(2, 5.0), (1, 4.0)]
    assert grouped([(1, 2.0), (1, 3.0)], 0) == [(1, 2.0), (1, 3.0)]
    speed, loss = figures([(1.0, 9.0)] * 10, 0, 10)
    assert speed == 9.0 and loss == 0, "a unit a node: only the calibration is lost"
    assert len(repeated([(1, 2.0)], 100)) == 50


def main(arguments):
    if arguments == ["--self-test"]:
        return self_test()
    if not arguments or arguments[0] in ("-h", "--help"):
        print(__doc__.strip(), file=sys.stdout if arguments else sys.stderr)
        sys.exit(0 if arguments else 2)
    wanted = float(arguments[arguments.index("--of") + 1]) if "--of" in arguments else WORK
    pieces = repeated(load(arguments[0]), wanted)
    if "--picture" in arguments:
        pathlib.Path(arguments[arguments.index("--picture") + 1]).write_text(picture(pieces))
    else:
        table(pieces)


if __name__ == "__main__":
    main(sys.argv[1:])
