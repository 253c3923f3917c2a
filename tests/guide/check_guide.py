#!/usr/bin/env python3
"""Holds the guide against its examples.

usage: check_guide.py ROOT | --run ROOT EXAMPLE PROGRAM | --self-test

A ```cpp block of a page under docs/guide that names a file (`docs/guide/examples/NAME.cpp` in the line of text
before it) is that file's text; every example is quoted by a page and has at most 40 lines; files that a page links
to exist; every row of the feature table has as many cells as its head.

--run starts an example: it returns 0, and prints what stands on its page after "It prints", where that is said. The
engine gives the same bits everywhere, so the texts are equal.
"""

import pathlib
import re
import subprocess
import sys
import tempfile

MOST_LINES = 40
LINK = re.compile(r"\]\(([^)#\s]+)(?:#[^)\s]*)?\)")
NAMED = re.compile(r"`(docs/guide/examples/\w+\.cpp)`")


def cpp_blocks(page):
    """(line number, file named before it or None, text) of each ```cpp block."""
    last_text, start, lines = "", 0, None
    for number, line in enumerate(page.split("\n"), 1):
        if lines is not None:
            if line == "```":
                name = NAMED.search(last_text)
                yield start, name and name.group(1), "".join(each + "\n" for each in lines)
                lines, last_text = None, ""
            else:
                lines.append(line)
        elif line == "```cpp":
            start, lines = number, []
        elif line.strip():
            last_text = line


def without_blocks(page):
    return re.sub(r"^```.*?^```$", "", page, flags=re.M | re.S)


def check_table(name, page):
    columns = None
    for line in without_blocks(page).split("\n"):
        if not line.startswith("|"):
            columns = None
            continue
        cells = len(re.sub(r"`[^`]*`", "", line).strip().strip("|").split("|"))
        columns = columns or cells
        if cells != columns:
            yield f"{name}: {cells} cells where the table has {columns}: {line[:60]}"


def check(root):
    guide = root / "docs/guide"
    examples = {f"docs/guide/examples/{path.name}": path.read_text() for path in guide.glob("examples/*.cpp")}
    pages = {path.relative_to(root).as_posix(): path.read_text() for path in sorted(guide.glob("*.md"))}
    quoted = set()
    for name, page in pages.items():
        for line, file, text in cpp_blocks(page):
            quoted.add(text)
            if file and file not in examples:
                yield f"{name}:{line}: {file} is not there"
            elif file and text != examples[file]:
                yield f"{name}:{line}: differs from {file}"
        for target in LINK.findall(without_blocks(page)):
            if "://" not in target and not (guide / target).exists():
                yield f"{name}: {target} is not there"
        yield from check_table(name, page)
    for file, text in sorted(examples.items()):
        if text not in quoted:
            yield f"{file}: no page quotes it as it is"
        if text.count("\n") > MOST_LINES:
            yield f"{file}: {text.count(chr(10))} lines, more than {MOST_LINES}"
    if not examples or not pages:
        yield "the guide has no pages or no examples"


def said_output(page, example):
    """What the page says that the example prints; None where it says nothing."""
    after = page.partition("```cpp\n" + example + "```\n")[2]
    said = re.match(r"\s*It prints\s*```\n(.*?)^```$", after, flags=re.M | re.S)
    return said and said.group(1)


def run(root, example, program):
    result = subprocess.run([program], capture_output=True, text=True, timeout=50)
    if result.returncode != 0:
        yield f"{example} returned {result.returncode} and printed:\n{result.stdout}{result.stderr}"
    text = (root / f"docs/guide/examples/{example}.cpp").read_text()
    for path in sorted((root / "docs/guide").glob("*.md")):
        said = said_output(path.read_text(), text)
        if said is not None and said != result.stdout:
            yield f"docs/guide/{path.name} says that {example} prints\n{said}but it prints\n{result.stdout}"


def self_test():
    def faults(page, example="int main() {}\n"):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "docs/guide/examples").mkdir(parents=True)
            (root / "docs/guide/examples/one.cpp").write_text(example)
            (root / "docs/guide/page.md").write_text(page)
            return list(check(root))

    head, name = "# Page\n\n", "`docs/guide/examples/one.cpp`:\n\n"
    good = head + name + "```cpp\nint main() {}\n```\n"
    cases = [
        (good, 0),
        (good + "[one](examples/one.cpp) and | a | cell\n", 0),
        (good + "[two](examples/two.cpp)\n", 1),
        (good + "\n| a | b |\n|---|---|\n| `x|y` | 2 |\n", 0),
        (good + "\n| a | b |\n|---|---|\n| 1 |\n", 1),
        (good.replace("one.cpp", "two.cpp"), 1),
        (good.replace("{}", "{ }"), 2),  # the block differs, and nothing else quotes the file
        (head + "```cpp\nint main() {}\n```\n", 0),
        (head, 1),
    ]
    found = [(page, count, len(faults(page))) for page, count in cases]
    wrong = [f"{now} faults, not {count}, in:\n{page}" for page, count, now in found if now != count]
    if said_output(good + "\nIt prints\n\n```\nhello\n```\n", "int main() {}\n") != "hello\n" or said_output(good, "x"):
        wrong.append("what a page says that an example prints is not found")
    long_one = "int x;\n" * (MOST_LINES + 1)
    if len(faults(head + name + "```cpp\n" + long_one + "```\n", long_one)) != 1:
        wrong.append("an example of 41 lines passes")
    return wrong


def main():
    arguments = sys.argv[1:]
    if arguments == ["--self-test"]:
        faults = self_test()
    elif len(arguments) == 4 and arguments[0] == "--run":
        faults = list(run(pathlib.Path(arguments[1]), *arguments[2:]))
    elif len(arguments) == 1:
        faults = list(check(pathlib.Path(arguments[0])))
    else:
        sys.exit(__doc__)
    print("\n".join(faults) if faults else "the guide and its examples agree")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
