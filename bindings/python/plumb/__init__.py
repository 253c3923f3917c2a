"""plumb: a 2D rigid-body engine. SI units (m, kg, s, rad), y up, angles counter-clockwise.

World steps bodies, shapes and joints that come and go; Simulation steps a scene, in fixed steps or to a tolerance;
Batch steps copies of a world side by side. compare, tune and hunt call the harness. plumb.view draws worlds with
matplotlib.
"""

from ._contact import Contact
from ._errors import (Error, FileError, InvalidValue, RunError, SceneSyntaxError, UnknownName, Unsupported)
from ._plumb import (Batch, Body, Box, Capsule, Chain, Circle, Distance, Friction, Gear, Joint, LawBody, Material, Motor, Mouse,
                     PastPoses, Polygon, Prismatic, Pulley, Ratchet, Revolute, Rollback, Segment, Shape, ShapeDefinition, Simulation, Weld,
                     Wheel, World, __version__, scene_from_json)
from .harness import compare, hunt, tune

__all__ = [
    "Batch", "Body", "Box", "Capsule", "Chain", "Circle", "Contact", "Distance", "Error", "FileError", "Friction", "Gear",
    "InvalidValue", "Joint", "LawBody", "Material", "Motor", "Mouse", "PastPoses", "Polygon", "Prismatic", "Pulley", "Ratchet", "Revolute",
    "Rollback", "RunError", "SceneSyntaxError", "Segment", "Shape", "ShapeDefinition", "Simulation", "UnknownName", "Unsupported", "Weld",
    "Wheel", "World", "__version__", "compare", "hunt", "scene_from_json", "tune",
]
