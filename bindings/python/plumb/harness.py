"""compare, tune and hunt: the harness of the program `plumb`, called from Python.

The program is the one that PLUMB_PROGRAM names, that the package brought along (a wheel built with the setting
`harness=yes`), or the first `plumb` on the search path.
"""

import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Mapping

from . import _json
from ._errors import Error, FileError, InvalidValue, UnknownName

# Exit codes of the program: what it was asked for is in its output with both of these.
_ANSWERED = (0, 1)


def program():
    """Path of the program `plumb`. Raises FileError where there is none."""
    name = os.environ.get("PLUMB_PROGRAM") or _brought() or shutil.which("plumb")
    if not name:
        raise FileError("The program plumb was not found: install it, build the wheel with harness=yes, or set PLUMB_PROGRAM.")
    return name


def _brought():
    path = pathlib.Path(__file__).with_name("bin") / "plumb"
    return str(path) if path.exists() else None


def compare(*cases, engines=None, commands=None, size=None, dt=None, timeout=None, cost=True, out=None):
    """Runs cases on engines, holds each run against the truth, and measures what a step costs.

    cases: names of scenarios, variants or sizes; paths of case files or folders of them; case files as dicts
    (docs/cases.md); none: all scenarios. engines: names, None: those that are linked in. commands: programs that speak
    docs/protocol.md, a dict of name and command line. dt: step, s. timeout: s a run may take. out: a folder to which
    the results and a report are added.

    Returns the results as dicts, one a case and engine, with `label`, `engine`, `status`, `metrics`, `checks`, `cost`
    (ns) and `unexpected`, the names of checks that missed and should not have. Raises Error where the program refuses.
    """
    with tempfile.TemporaryDirectory() as folder:
        options = [f"--out={os.fspath(out)}"] if out else [f"--out={folder}", "--no-report"]
        options += [] if cost else ["--no-cost"]
        options += _common(engines, commands) + _given(size=size, dt=dt, timeout=timeout)
        return _answers(["compare", *_named(cases, folder), *options, "--format=json"])


def tune(case, *, tolerance=None, cost_us=None, metric=None, engines=None, commands=None, size=None, dt=None,
         budget=None, duration=None):
    """Finds the cheapest settings that reach an accuracy, or the most accurate within a cost, on every engine.

    case: a scenario's name, the path of a scene or case file, or either as a dict. tolerance: largest error, in the
    metric's unit; cost_us: instead, the largest cost of a step of the game, us. metric: position_error (m) unless
    given. dt: step of the game, s; budget: s that the search may take; duration: s that a file's scene runs.

    Returns a dict with `answers`, cheapest first: each has `engine`, the settings and what they reach (`reaches`), or
    the `problem` of an engine that cannot. Raises Error where the program refuses.
    """
    with tempfile.TemporaryDirectory() as folder:
        options = _common(engines, commands) + _given(tolerance=tolerance, cost_us=cost_us, metric=metric, size=size,
                                                      dt=dt, budget=budget, duration=duration)
        return _answer(["tune", *_named([case], folder), *options, "--format=json"])


def hunt(*families, engines=None, commands=None, seed=None, minutes=None, scenes=None, shrinks=None, jobs=None, out=None):
    """Runs random scenes and judges them without an answer sheet: by laws, symmetries and the other engines.

    families: structures to draw scenes from (`plumb hunt --list`), none: all. minutes: how long; scenes: how many at
    most; out: folder for the findings, so that a later hunt goes on.

    Returns the kinds of findings as dicts: `kind`, `judge`, `engines`, `what`, `right`, and `finding`, the smallest
    one with its scene as a dict that `Simulation` and `World.add_scene` take. Raises Error where the program refuses.
    """
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(out or folder)
        options = _common(engines, commands) + _given(seed=seed, minutes=minutes, scenes=scenes, shrinks=shrinks, jobs=jobs)
        for family in families:
            _require_name("family", family)
        found = _answer(["hunt", *families, *options, f"--out={os.fspath(place)}", "--format=json"])
        for kind in found:
            kind["finding"] = json.loads((place / kind["file"]).read_text())
        return found


def _given(**options):
    given = [(f"--{name.replace('_', '-')}", value) for name, value in options.items() if value is not None]
    return [f"{name}={value!r}" if isinstance(value, float) else f"{name}={value}" for name, value in given]


def _common(engines, commands):
    options = []
    if engines is not None:
        options += [f"--engine={engines if isinstance(engines, str) else ','.join(engines)}"]
    for name, command in (commands or {}).items():
        options += [f"--engine-command={name}={command}"]
    return options


def _named(cases, folder):
    """Names for the command line; dicts become files of `folder`."""
    names = []
    for number, case in enumerate(cases):
        if isinstance(case, (str, os.PathLike)):
            names.append(_require_name("case", os.fspath(case)))
            continue
        if not isinstance(case, Mapping):
            raise TypeError(f"a case is a name, a path or a dict, not {case!r}")
        path = pathlib.Path(folder) / f"{number}" / f"{case.get('name') or 'case'}.json".replace("/", "_")
        path.parent.mkdir()
        path.write_text(_json.text(case))
        names.append(str(path))
    return names


def _require_name(field, name):
    """Returns a name; refuses one that the program would take for an option."""
    if isinstance(name, str) and name and not name.startswith("-"):
        return name
    problem = "must be a name that begins with no '-'; a file can be given as './-name'"
    raise _with_parts(InvalidValue(f"{field} {name!r}: {problem}"), field, "name", str(name), problem)


def _with_parts(error, subject, field, value, problem):
    error.subject, error.field, error.value, error.problem = subject, field, value, problem
    return error


def _refusal(text):
    """Returns the exception for what the program says when it refuses."""
    option = re.match(r"plumb: --([\w-]+) is '([^']*)': (.*)", text, re.S)
    if option:
        return _with_parts(InvalidValue(text), "options", option[1].replace("-", "_"), option[2], option[3])
    found = re.match(r"plumb: (\w+) '([^']*)':? (.*)", text, re.S)
    if not found:
        return Error(text)
    subject, value, problem = found.groups()
    unknown = re.search(r"there is (none by this name|no such)|is unknown", problem)
    kind = UnknownName if unknown else FileError if subject == "file" and "cannot be" in problem else Error
    return _with_parts(kind(text), subject, "name", value, problem)


def _answers(arguments):
    """Returns the program's answers, one a line of JSON; there is at least one."""
    text = _run(arguments)
    if not text.strip():
        raise Error(f"{program()} {arguments[0]} printed nothing: is it the program plumb, and of this version?")
    try:
        return [json.loads(line) for line in text.splitlines()]
    except json.JSONDecodeError as error:
        raise Error(f"{program()} {arguments[0]} did not print JSON, but {text[:60]!r}: is it the program plumb?") from error


def _answer(arguments):
    """Returns the program's one answer."""
    text = _run(arguments)
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        printed = repr(text[:60]) if text.strip() else "nothing"
        raise Error(f"{program()} {arguments[0]} printed {printed} in place of JSON: is it the program plumb?") from error


def _run(arguments):
    name = program()
    try:
        run = subprocess.run([name, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
    except OSError as error:
        raise FileError(f"The program {name} does not start: {error.strerror}.") from error
    if run.returncode == 128 + signal.SIGINT:
        raise KeyboardInterrupt
    if run.returncode not in _ANSWERED:
        raise _refusal(run.stderr.strip() or f"{name} ended with code {run.returncode}")
    return run.stdout
