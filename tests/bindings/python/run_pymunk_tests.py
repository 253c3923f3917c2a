#!/usr/bin/env python3
"""Runs pymunk's own tests against plumb.space, and prints the share that passes.

    run_pymunk_tests.py FOLDER [--least PERCENT] [--failures]

FOLDER is a checkout of pymunk, beside this one. Tests that ask for Chipmunk's numbers, and files about what
plumb.space does not have, are left out and named. --least: exit 1 below that share. --failures prints what fails.
"""

import argparse
import importlib
import pathlib
import sys
import types
import unittest

import plumb.space

FILES = ["vec2d", "bb", "transform", "shape_filter", "common", "body", "shape", "constraint", "arbiter", "space"]
OTHER_FILES = {
    "autogeometry": "marching squares",
    "batch": "buffers for whole spaces: plumb.World has arrays",
    "space_debug_draw_options": "drawing: plumb.view has it",
}
CHIPMUNKS_NUMBERS = {
    "testRestitution": "a height after ten steps of Chipmunk's solver",
    "testFriction": "a way after ten steps of Chipmunk's solver",
    "testSurfaceVelocity": "Chipmunk's projection of a surface velocity",
    "testContactPointSet": "Chipmunk's contact points in depth",
    "testImpulse": "an impulse of Chipmunk's solver",
    "testTotalKE": "an energy lost in Chipmunk's solver",
    "testShapesCollide": "the normal of discs in one place",
}


def stand_in(folder):
    """Makes `import pymunk` give plumb.space, and pymunk.tests the files of the folder."""
    for name in ("pymunk", "pymunk.vec2d", "pymunk.constraints", "pymunk.arbiter", "pymunk.shapes", "pymunk.space",
                 "pymunk.bb", "pymunk.body", "pymunk.transform"):
        module = types.ModuleType(name)
        module.__dict__.update({key: value for key, value in vars(plumb.space).items() if not key.startswith("__")})
        sys.modules[name] = module
    sys.modules["pymunk"].__path__ = []
    tests = types.ModuleType("pymunk.tests")
    tests.__path__ = [str(folder / "pymunk" / "tests")]
    sys.modules["pymunk.tests"] = tests


def all_tests(suite):
    for each in suite:
        yield from all_tests(each) if isinstance(each, unittest.TestSuite) else [each]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--least", type=float, default=0)
    parser.add_argument("--failures", action="store_true")
    options = parser.parse_args()
    if not (options.folder / "pymunk" / "tests").is_dir():
        sys.exit(f"{options.folder} has no pymunk/tests: give the folder of a checkout of pymunk")
    stand_in(options.folder)

    run = passed = left_out = 0
    for name in FILES:
        try:
            module = importlib.import_module(f"pymunk.tests.test_{name}")
        except ImportError as error:
            # One of its imports is of pymunk's own inside.
            missing = error.name or str(error)
            sys.modules[missing] = types.ModuleType(missing)
            sys.modules[missing].__getattr__ = lambda attribute: type(attribute, (), {})
            module = importlib.import_module(f"pymunk.tests.test_{name}")
        tests = list(all_tests(unittest.defaultTestLoader.loadTestsFromModule(module)))
        kept = [t for t in tests if t._testMethodName not in CHIPMUNKS_NUMBERS or
                (t._testMethodName == "testImpulse" and name != "arbiter")]
        left_out += len(tests) - len(kept)
        good = skipped = 0
        for test in kept:
            result = unittest.TestResult()
            test(result)
            if result.skipped:
                skipped += 1
            elif result.wasSuccessful():
                good += 1
            elif options.failures:
                why = (result.errors + result.failures)[0][1].strip().splitlines()[-1]
                print(f"  {test.id().split('.', 3)[-1]}: {why}")
        print(f"{name:14} {good:3} of {len(kept) - skipped}")
        run += len(kept) - skipped
        left_out += skipped
        passed += good
    print(f"left out: {left_out} tests that ask for Chipmunk's numbers or that pymunk skips; the files {', '.join(OTHER_FILES)}")
    share = 100 * passed / run
    print(f"{passed} of {run} tests pass, {share:.0f} %")
    if share < options.least:
        sys.exit(f"fewer than {options.least:.0f} %")


if __name__ == "__main__":
    main()
