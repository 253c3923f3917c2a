"""JSON of scenes and cases that are given as dicts."""

import json


def text(given):
    """Returns `given` as JSON; arrays and numbers of numpy are lists and numbers there."""
    return json.dumps(given, default=_plain)


def _plain(value):
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{value!r} cannot be in a scene: it is no dict, list, text or number")
