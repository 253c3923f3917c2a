#!/usr/bin/env python3
"""Checks that a new scenario is one file: the complete file of docs/adding-a-scenario.md, dropped into a copy of
the checkout, shows up in `plumb list`, `plumb compare`, the tests and the benchmarks without another edit.

    drop_in.py CHECKOUT WORK [CMAKE ARGUMENT...]
"""

import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
sys.dont_write_bytecode = True

import checkout_copy  # noqa: E402

PAGE = "docs/adding-a-scenario.md"
LONGEST = 40  # lines


def first_block(page):
    match = re.search(r"^```cpp\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    if not match:
        raise SystemExit(f"{PAGE} has no block of C++")
    return match.group(1)


def require(condition, message, output=""):
    if not condition:
        raise SystemExit(f"{output}\n{message}")
    print(f"ok  {message}", flush=True)


def what_is_there(build):
    """What each place knows of: name of the place -> its listing."""
    program = build / "bin" / "plumb"
    places = {
        "plumb list": [program, "list"],
        "ctest -N": ["ctest", "--test-dir", build, "-N"],
        "plumb bench --benchmark_list_tests": [program, "bench", "--benchmark_list_tests"],
    }
    return {place: checkout_copy.run(command)[1] for place, command in places.items()}


def main(arguments):
    if len(arguments) < 2:
        print(__doc__, file=sys.stderr)
        return 2
    checkout, work, options = pathlib.Path(arguments[0]), pathlib.Path(arguments[1]), arguments[2:]
    text = first_block((checkout / PAGE).read_text(encoding="utf-8"))
    named = re.search(r'\.name = "([a-z0-9_]+)"', text)
    require(named, "the file names its scenario")
    name = named.group(1)
    lines = len(text.splitlines())
    require(lines <= LONGEST, f"{name}: {lines} lines of at most {LONGEST}")

    tree = work / "tree"
    checkout_copy.sync(checkout, tree)
    build = checkout_copy.configure(tree, options)
    targets = ["programs", "plumb_bench", "test_agreement"]
    checkout_copy.run(["ninja", "-C", build, *targets])
    for place, listing in what_is_there(build).items():
        require(name not in listing, f"{place} does not know {name} beforehand", listing)

    file = tree / "scenarios" / f"{name}.cpp"
    require(not file.exists(), f"{file.name} is new")
    file.write_text(text, encoding="utf-8")
    checkout_copy.run(["ninja", "-C", build, *targets])
    for place, listing in what_is_there(build).items():
        require(name in listing, f"{place} knows {name}", listing)

    status, output = checkout_copy.run([build / "bin" / "plumb", "compare", name], check=False)
    require(status == 0 and name in output, f"plumb compare {name}", output)
    status, output = checkout_copy.run(["ctest", "--test-dir", build, "-L", "agreement", "-R", name,
                                        "--no-tests=error", "--output-on-failure"], check=False)
    require(status == 0, f"the tests of {name} pass", output)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
