#!/usr/bin/env python3
"""Checks a page of a language: check_page.py PAGE EXAMPLE

The page quotes the example word for word; what stands after the next "It prints" is printed, to be compared with the
program."""

import pathlib
import re
import sys


def main():
    page, example = pathlib.Path(sys.argv[1]).read_text(), pathlib.Path(sys.argv[2])
    name = re.escape("/".join(example.parts[-4:]))
    quoted = re.search(rf"`{name}`:\n\n```\w+\n(.*?)```\n", page, re.S)
    if not quoted or quoted.group(1) != example.read_text():
        sys.exit(f"{sys.argv[1]} does not quote {example} as it is")
    printed = re.search(r"It prints\n\n```\n(.*?)```\n", page[quoted.end():], re.S)
    sys.stdout.write(printed.group(1))


if __name__ == "__main__":
    main()
