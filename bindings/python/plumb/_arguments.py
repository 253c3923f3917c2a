"""Short messages for arguments that do not fit, in place of pybind11's list of signatures."""

import re
from collections.abc import Sequence

_BITS = {"category": (0, 2**64), "mask": (0, 2**64), "user_data": (0, 2**64), "index": (-2**31, 2**31)}


def explain(message, args, kwargs, setter=""):
    """Returns what is wrong with the arguments of a call, or None for an error of another kind.

    message: pybind11's, which has the signature. setter: name of the property that was set.
    """
    called = re.match(r"(\w*)\(\): incompatible (?:function|constructor) arguments", message)
    signatures = re.findall(r"^    \d+\. ([\w.]*)\((.*)\)(?: -> .*)?$", message, re.M)
    if not called or len(signatures) != 1:
        return None
    kind, text = signatures[0]
    name = called[1] if not kind else _plain(kind)
    parameters, positional = _parameters(text)
    args = list(args)[1:] if kind else list(args)
    if setter:
        parameters = {given: (setter if given != "self" else given, *rest) for given, (_, *rest) in parameters.items()}
    own = [given for given in parameters if given != "self"]
    valid = f"; it has {', '.join(own)}" if own else "; it has none"
    for given in kwargs:
        if given not in own:
            return f"{name}(): {given} is not an argument{valid}"
    most = positional if positional is not None else len(parameters)
    if len(args) > most:
        taken = most - ("self" in parameters)
        return f"{name}(): {len(args) - ('self' in parameters)} arguments by position, of which it takes {taken}{valid}"
    given = dict(zip(parameters, args))
    for twice in given.keys() & kwargs.keys():
        return f"{name}(): {twice} is given twice"
    given.update(kwargs)
    where = "" if setter else f"{name}(): "
    for parameter, (shown, wanted, optional) in parameters.items():
        if parameter not in given:
            if not optional:
                return f"{name}(): {parameter} is missing{valid}"
            continue
        value = given[parameter]
        if not _fits(wanted, value):
            return f"{where}{shown} is {_shown(value)}: must be {_words(wanted)}"
        least, most = _BITS.get(shown, (-2**31, 2**31))
        if wanted == "int" and not least <= int(value) < most:
            return f"{where}{shown} is {_shown(value)}: must be from {least} to {most - 1}"
    return f"{name}(): the arguments do not fit{valid}"


def _plain(name):
    return name.replace("plumb._plumb.", "")


def _parts(text):
    """Splits at the commas that are in no brackets or quotes."""
    parts, depth, quoted = [""], 0, False
    for letter in text:
        quoted ^= letter == "'"
        depth += 0 if quoted else (letter in "([{<") - (letter in ")]}>")
        if letter == "," and depth == 0 and not quoted:
            parts.append("")
        else:
            parts[-1] += letter
    return [part.strip() for part in parts if part.strip()]


def _parameters(text):
    """Returns (name shown, type, optional) by name, and how many may be given by position, or None for all."""
    parameters, positional = {}, None
    for part in _parts(text):
        if part == "*":
            positional = len(parameters)
            continue
        name, _, kind = part.partition(": ")
        kind, default, _ = kind.partition(" = ")
        parameters[name] = name, kind, bool(default)
    return parameters, positional


def _inner(kind):
    return _parts(kind[kind.index("[") + 1:-1])


def _sequence(value):
    return isinstance(value, Sequence) and not isinstance(value, (str, bytes)) or hasattr(value, "tolist")


def _fits(kind, value):
    """True unless `value` is certain to be refused as `kind`."""
    number = hasattr(value, "__float__") or hasattr(value, "__index__")
    if kind == "float":
        return number
    if kind == "int":
        return hasattr(value, "__index__")
    if kind == "str":
        return isinstance(value, (str, bytes))
    if kind == "bool":
        return type(value).__name__ in ("bool", "bool_")
    if kind == "None":
        return value is None
    if kind == "function" or kind.startswith("Callable"):
        return callable(value)
    if kind.startswith("numpy.ndarray"):
        return value is not None and not isinstance(value, (str, bytes))
    if kind.startswith("plumb._plumb."):
        return any(each.__name__ == _plain(kind) for each in type(value).__mro__)
    if kind.startswith("Optional["):
        return value is None or _fits(_inner(kind)[0], value)
    if kind.startswith("Union["):
        return any(_fits(each, value) for each in _inner(kind))
    if kind.startswith(("Tuple[", "tuple[")):
        return _sequence(value) and len(value) == len(_inner(kind)) and all(map(_fits, _inner(kind), value))
    if kind.startswith("List["):
        each = re.fullmatch(r"(.*?)(?:\[(\d+)\])?", _inner(kind)[0])
        if not _sequence(value) or (each[2] and len(value) != int(each[2])):
            return False
        return all(_fits(each[1], one) for one in value)
    return kind != "buffer" or _has_bytes(value)


def _has_bytes(value):
    try:
        memoryview(value)
    except TypeError:
        return False
    return True


def _words(kind):
    words = {"float": "a number", "int": "a whole number", "str": "a text", "bool": "True or False", "None": "None",
             "tuple[float, float]": "two numbers, (x, y)", "buffer": "bytes, or an object that has some",
             "function": "a function"}
    if kind in words:
        return words[kind]
    if kind.startswith("Callable"):
        return "a function"
    if kind.startswith("numpy.ndarray"):
        return "an array of numbers"
    if kind.startswith("Optional["):
        return f"{_words(_inner(kind)[0])} or None"
    if kind.startswith("Union["):
        return " or ".join(_words(each) for each in _inner(kind))
    if kind.startswith(("Tuple[", "tuple[")):
        return f"({', '.join(_words(each) for each in _inner(kind))})"
    if kind.startswith("List["):
        each = re.fullmatch(r"(.*?)(?:\[(\d+)\])?", _inner(kind)[0])
        return f"a list of {each[2] + ' of ' if each[2] else ''}{_words(each[1])}"
    return f"a plumb.{_plain(kind)}" if kind.startswith("plumb._plumb.") else kind


def _shown(value):
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."
