"""The exceptions of plumb. Each has the parts of its sentence as attributes."""


class Error(Exception):
    """A value, a name, a scene or a run that plumb cannot accept.

    subject: the thing ("body 'ball'"); field: its member ("mass"); value: the value given, as text; problem: what is
    wrong and its remedy; line: of a scene's text, from 1, or 0.
    """

    subject = field = value = problem = ""
    line = 0


class SceneSyntaxError(Error, ValueError):
    """Not JSON, or JSON of the wrong shape."""


class InvalidValue(Error, ValueError):
    """A value out of its range: NaN, a negative mass, dt <= 0."""


class UnknownName(Error, LookupError):
    """An unknown or duplicate name, or a handle of a destroyed object."""


class Unsupported(Error, NotImplementedError):
    """Well formed, but not supported."""


class RunError(Error, RuntimeError):
    """The run could not continue: a non-finite state, a work limit, a missed bound."""


class FileError(Error, OSError):
    """A file that cannot be opened, read or written."""


# By plumb::Error::Kind.
CLASSES = (SceneSyntaxError, InvalidValue, UnknownName, Unsupported, RunError, FileError)
