#!/usr/bin/env python3
"""Writes one self-contained HTML file: bundle.py PAGE_FOLDER PROGRAM.wasm OUT.html

The modules become one script: they are concatenated in the order of their imports, without the import and export
lines. So no two modules may declare the same name at top level, and no import may rename what it imports.
"""
import base64
import gzip
import pathlib
import re
import sys

IMPORT = re.compile(r'^import \{[^}]*\} from "\./([^"]+)";\n', re.MULTILINE)
EXPORT = re.compile(r"^export (?=(?:async )?(?:class|const|function) )", re.MULTILINE)
DIGITS = str.maketrans("<&", ".,")  # which HTML would read as its own; page/base85.mjs has the same
DECLARED = re.compile(r"^(?:async )?(?:class|const|let|function\*?) (\w+)", re.MULTILINE)


def ordered(folder, name, done):
    """Returns the modules that `name` needs, and then `name` itself, each once."""
    if name not in done:
        done[name] = None  # while its imports are read
        text = (folder / name).read_text(encoding="utf-8")
        for other in IMPORT.findall(text):
            if other in done and done[other] is None:
                sys.exit(f"bundle.py: {name} and {other} import each other")
            ordered(folder, other, done)
        done[name] = text
        done[name] = done.pop(name)  # after what it needs
    return done


def script(folder):
    parts, owner = [], {}
    for name, text in ordered(folder, "main.mjs", {}).items():
        text = EXPORT.sub("", IMPORT.sub("", text))
        if re.search(r"^(?:import|export)\b", text, re.MULTILINE):
            sys.exit(f"bundle.py: {name} imports or exports in a way that is not understood here")
        for declared in DECLARED.findall(text):
            if owner.setdefault(declared, name) != name:
                sys.exit(f"bundle.py: {declared} is declared in {owner[declared]} and in {name}")
        parts.append(f"// {name}\n{text}")
    return "\n".join(parts).replace("</script", "<\\/script")


def main():
    folder, program, out = map(pathlib.Path, sys.argv[1:])
    packed = base64.b85encode(gzip.compress(program.read_bytes(), 9, mtime=0)).decode().translate(DIGITS)
    values = {"style.css": (folder / "style.css").read_text(encoding="utf-8"),
              "module": packed, "script": script(folder)}
    page = (folder / "index.html").read_text(encoding="utf-8")
    page = re.sub(r"\{\{([\w.]+)\}\}", lambda match: values[match[1]], page)
    out.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
