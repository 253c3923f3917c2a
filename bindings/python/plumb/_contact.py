"""What hooks and Body.contacts give."""

from typing import TypedDict


class Contact(TypedDict):
    """A contact of two shapes: m, N s, m/s."""

    shape_a: "Shape"
    shape_b: "Shape"
    normal: tuple[float, float]
    points: list[tuple[float, float]]
    separations: list[float]
    impulses: list[float]
    approach: float
    step_impulse: float
