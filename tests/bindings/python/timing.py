#!/usr/bin/env python3
"""Times reading in Python, and a loop of step and read against the same steps without Python.

    timing.py           prints the figures
    timing.py --check   exit 1 where one is beyond its bound

Both loops are of one world: `step(count=N)` steps in C++ alone. They take turns, so that other load hits both alike, and
the medians of their blocks are compared.
"""

import statistics
import sys
import time

import plumb


def microseconds(work):
    begin = time.perf_counter_ns()
    work()
    return (time.perf_counter_ns() - begin) / 1000


def pyramid():
    world = plumb.World(sleeping=False)
    world.create_body(plumb.Box(100, 2), type="static", position=(0, -1))
    for row in range(10):
        for column in range(10 - row):
            world.create_body(plumb.Box(1, 1), position=(column + row / 2, row + 0.5))
    return world


def main():
    many = plumb.World()
    for i in range(10000):
        many.create_body(plumb.Circle(0.4), position=(i % 100, i // 100))
    views = statistics.median(microseconds(lambda: (many.centres, many.angles)) for _ in range(1000))
    copies = statistics.median(microseconds(lambda: many.poses) for _ in range(1000))
    print(f"poses of 10,000 bodies: {views:.2f} us as views, {copies:.1f} us as a copy")

    world = pyramid()
    world.step(count=300)

    def loop():
        for _ in range(50):
            world.step(1 / 60)
            world.centres, world.angles

    ours, theirs = [], []
    for _ in range(40):
        ours.append(microseconds(loop) / 50)
        theirs.append(microseconds(lambda: world.step(1 / 60, count=50)) / 50)
    # A neighbour takes its share at random; the quietest blocks are those of the code itself.
    python, cpp = min(ours), min(theirs)
    print(f"a step of {world.counts['bodies']} bodies: {python:.2f} us with reading in Python, {cpp:.2f} us in C++, "
          f"ratio {python / cpp:.3f}")
    if sys.argv[1:] == ["--check"] and (views > 20 or copies > 100 or python / cpp > 1.15):
        sys.exit("beyond 20 us, 100 us or 1.15")


if __name__ == "__main__":
    main()
