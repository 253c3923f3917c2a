"""A subset of pymunk's interface over plumb, for programs that come from there (docs/python.md).

Names and signatures are pymunk's, numbers are plumb's: `Space.step` runs plumb's solver in double precision. Angles in
rad; other units are the program's own, as long as they belong together. What has no counterpart raises
NotImplementedError when it is added to a space.
"""

from plumb.space.arbiter import Arbiter
from plumb.space.bodies import Body
from plumb.space.collisions import empty_callback
from plumb.space.constraint import Constraint
from plumb.space.constraints import (
    GearJoint, GrooveJoint, PinJoint, PivotJoint, RatchetJoint, RotaryLimitJoint, SimpleMotor, SlideJoint)
from plumb.space.moments import (
    area_for_circle, area_for_poly, area_for_segment, moment_for_box, moment_for_circle, moment_for_poly,
    moment_for_segment)
from plumb.space.shapes import Circle, Poly, Segment, Shape
from plumb.space.space import Space
from plumb.space.springs import DampedRotarySpring, DampedSpring
from plumb.space.values import (
    BB, ContactPoint, ContactPointSet, PointQueryInfo, SegmentQueryInfo, ShapeFilter, ShapeQueryInfo, Transform,
    Vec2d)

version = "0.1"

__all__ = [
    "Arbiter", "BB", "Body", "Circle", "Constraint", "ContactPoint", "ContactPointSet", "DampedRotarySpring",
    "DampedSpring", "GearJoint", "GrooveJoint", "PinJoint", "PivotJoint", "PointQueryInfo", "Poly", "RatchetJoint",
    "RotaryLimitJoint", "Segment", "SegmentQueryInfo", "Shape", "ShapeFilter", "ShapeQueryInfo", "SimpleMotor",
    "SlideJoint", "Space", "Transform", "Vec2d", "area_for_circle", "area_for_poly", "area_for_segment",
    "empty_callback", "moment_for_box", "moment_for_circle", "moment_for_poly", "moment_for_segment", "version"]
