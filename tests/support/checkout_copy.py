"""A second tree to change and build, beside the checkout."""

import filecmp
import os
import pathlib
import shutil
import subprocess

# What is made, not written.
LEFT_OUT = {".git", "build", "results", ".cache", "__pycache__"}


def files_below(root):
    """Paths of the files of a tree, relative to it."""
    for folder, folders, names in os.walk(root):
        folders[:] = [name for name in folders if name not in LEFT_OUT]
        for name in names:
            yield (pathlib.Path(folder) / name).relative_to(root)


def sync(source, target):
    """Makes `target` the same as `source`. Files that are the same already are not touched, so that a build in
    the copy goes on from where it was."""
    source, target = pathlib.Path(source), pathlib.Path(target)
    wanted = set(files_below(source))
    for path in set(files_below(target)) - wanted:
        (target / path).unlink()
    for path in wanted:
        copy = target / path
        if copy.is_file() and filecmp.cmp(source / path, copy, shallow=False):
            continue
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(source / path, copy)


def environment():
    """Python gives a process without a locale LC_CTYPE=C.UTF-8 (PEP 538). Compiler caches take the locale into
    account, so what is started from here goes without it, as the checkout's own build does."""
    variables = dict(os.environ)
    if "LANG" not in variables and "LC_ALL" not in variables:
        variables.pop("LC_CTYPE", None)
    return variables


def run(command, timeout=None, check=True):
    """Runs a command; returns (status, output). With `check` a failure ends the program with its output."""
    done = subprocess.run([str(word) for word in command], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace", timeout=timeout, check=False,
                          env=environment())
    if check and done.returncode != 0:
        raise SystemExit(f"{done.stdout}\n{' '.join(map(str, command))}: status {done.returncode}")
    return done.returncode, done.stdout


def configure(tree, arguments):
    """Configures build/release of the tree and returns its path: as deep as in the checkout, so that compiler
    caches see the same relative paths."""
    build = pathlib.Path(tree) / "build" / "release"
    run(["cmake", "-S", tree, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", *arguments])
    return build
