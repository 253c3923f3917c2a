"""JSON of scenes and cases that are given as dicts."""

import json
import math

from ._errors import InvalidValue

# Lists of a scene, with what one of their items is called.
_ITEMS = {"bodies": "body", "joints": "joint", "forces": "force"}


def text(given):
    """Returns `given` as JSON; arrays and numbers of numpy are lists and numbers there.

    Raises InvalidValue, which names the body and its field, for a number that is not finite: JSON has none.
    """
    try:
        return json.dumps(given, default=_plain, allow_nan=False)
    except ValueError:
        _refuse_not_finite(given)
        raise


def _plain(value):
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{value!r} cannot be in a scene: it is no dict, list, text or number")


def _refuse_not_finite(value, path="", subject="scene"):
    if isinstance(value, float) and not math.isfinite(value):
        error = InvalidValue(f"{subject}: {path or 'value'} is {value!r}: must be a finite number")
        error.subject, error.field, error.value, error.problem = subject, path, repr(value), "must be a finite number"
        raise error
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, dict):
        for field, inner in value.items():
            _refuse_not_finite(inner, f"{path}.{field}" if path and path != "scene" else str(field), subject)
    elif isinstance(value, (list, tuple)):
        for number, inner in enumerate(value):
            if path in _ITEMS and isinstance(inner, dict):
                name = inner.get("name")
                _refuse_not_finite(inner, "", f"{_ITEMS[path]} '{name}'" if name else f"{_ITEMS[path]} {number}")
            else:
                _refuse_not_finite(inner, f"{path}[{number}]", subject)
    elif not isinstance(value, (str, int, float, type(None))):
        _refuse_not_finite(_plain(value), path, subject)
