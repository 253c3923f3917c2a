"""Draws worlds with matplotlib (Debian: python3-matplotlib), still or as an animation. Lengths in m.

    import plumb.view
    plumb.view.draw(world)                                     # a picture of now
    plumb.view.animate(world, seconds=5).save("world.gif")     # or HTML(....to_jshtml()) in a notebook
"""

import math
import numbers

import matplotlib.animation
import matplotlib.axes
import matplotlib.patches
import matplotlib.pyplot
import matplotlib.transforms
import numpy as np

from ._errors import InvalidValue
from ._plumb import Box, Capsule, Circle, Polygon, Segment, World

COLOURS = {"static": "0.6", "kinematic": "tab:purple", "dynamic": "tab:blue"}
# Points of a half circle: a capsule's ends differ from round ones by 1 - cos(pi/32), 0.5 % of the radius.
HALF_CIRCLE = 17


def draw(world, axes=None, bounds=None):
    """Draws all shapes of a world and returns the View, whose `update()` follows the world.

    axes: of matplotlib, a new figure's unless given. bounds: (left, bottom, right, top), m; around all dynamic bodies
    unless given.
    """
    return View(world, axes, bounds)


def animate(world, seconds=5.0, *, fps=30, dt=1 / 60, substeps=4, before_step=None, axes=None, bounds=None):
    """Steps a world and returns matplotlib's FuncAnimation of it, at the world's own speed.

    seconds: how long; fps: frames a second; dt: step, s; before_step: called before each step, to apply forces.
    The world is stepped as the frames are made (by `save`, `to_jshtml` or a window), once.
    """
    for field, value in (("seconds", seconds), ("fps", fps), ("dt", dt)):
        if not isinstance(value, numbers.Real) or not 0 < value < math.inf:
            _refuse(field, value, "must be a positive number")
    if before_step is not None and not callable(before_step):
        raise TypeError(f"before_step is {before_step!r}: must be a function or None")
    view = View(world, axes, bounds)
    begin = world.time

    def frame(number):
        while world.time + dt / 2 < begin + number / fps:
            if before_step:
                before_step()
            world.step(dt, substeps)
        return view.update()

    return matplotlib.animation.FuncAnimation(view.axes.figure, frame, frames=1 + round(seconds * fps),
                                              init_func=view.update, interval=1000 / fps, repeat=False)


class View:
    """The shapes of a world as patches. Bodies that are created later are taken up by `update()`."""

    def __init__(self, world, axes=None, bounds=None):
        if not isinstance(world, World):
            raise TypeError(f"world is {world!r}: must be a plumb.World")
        if axes is not None and not isinstance(axes, matplotlib.axes.Axes):
            raise TypeError(f"axes is {axes!r}: must be axes of matplotlib or None")
        bounds = _known_bounds(bounds)
        self.world = world
        self.axes = axes if axes is not None else matplotlib.pyplot.subplots()[1]
        self._patches = {}
        self.axes.set_aspect("equal")
        left, bottom, right, top = bounds or _around(world)
        self.axes.set_xlim(left, right)
        self.axes.set_ylim(bottom, top)
        self.update()

    def update(self):
        """Moves the patches to where the bodies are; returns them."""
        here = {shape: body for body in self.world.bodies if body.enabled for shape in body.shapes}
        for shape in self._patches.keys() - here.keys():
            self._patches.pop(shape).remove()
        for shape, body in here.items():
            if shape not in self._patches:
                self._patches[shape] = self.axes.add_patch(_patch(shape.definition, body.type))
            pose = matplotlib.transforms.Affine2D().rotate(body.angle).translate(*body.position)
            self._patches[shape].set_transform(pose + self.axes.transData)
        return list(self._patches.values())


def _refuse(field, value, problem):
    error = InvalidValue(f"view: {field} is {value!r}: {problem}")
    error.subject, error.field, error.value, error.problem = "view", field, repr(value), problem
    raise error


def _known_bounds(bounds):
    if bounds is None:
        return None
    problem = "must be (left, bottom, right, top), m, of an area that is not empty"
    try:
        left, bottom, right, top = (float(each) for each in bounds)
    except (TypeError, ValueError):
        _refuse("bounds", bounds, problem)
    if not (-math.inf < left < right < math.inf and -math.inf < bottom < top < math.inf):
        _refuse("bounds", bounds, problem)
    return left, bottom, right, top


def _around(world):
    boxes = [body.box for body in world.bodies if body.type != "static" and body.shapes]
    if not boxes:
        boxes = [body.box for body in world.bodies if body.shapes] or [((-1, -1), (1, 1))]
    (left, bottom), (right, top) = np.min([b[0] for b in boxes], axis=0), np.max([b[1] for b in boxes], axis=0)
    margin = 0.5 * max(right - left, top - bottom)
    return left - margin, bottom - margin, right + margin, top + margin


def _patch(definition, body_type):
    style = {"facecolor": COLOURS[body_type], "edgecolor": "black", "alpha": 0.7, "linewidth": 0.8}
    geometry = definition.geometry
    if isinstance(geometry, Segment):
        style = {"facecolor": "none", "edgecolor": COLOURS[body_type], "linewidth": 1.5}
    outline = _outline(geometry)
    turn = np.array([[math.cos(definition.angle), math.sin(definition.angle)],
                     [-math.sin(definition.angle), math.cos(definition.angle)]])
    return matplotlib.patches.Polygon(np.asarray(outline) @ turn + definition.position, closed=True, **style)


def _arc(centre, radius, start, turn):
    angles = start + np.linspace(0, turn, HALF_CIRCLE)
    return np.asarray(centre) + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def _outline(geometry):
    """Points around a geometry in its own frame, counter-clockwise, m."""
    if isinstance(geometry, Circle):
        # The line to the centre and back shows how far the disc has turned.
        return np.concatenate([_arc((0, 0), geometry.radius, 0, math.pi), _arc((0, 0), geometry.radius, math.pi, math.pi),
                               [(0, 0)]])
    if isinstance(geometry, Capsule):
        (ax, ay), (bx, by) = geometry.start, geometry.end
        along = math.atan2(by - ay, bx - ax)
        return np.concatenate([_arc(geometry.end, geometry.radius, along - math.pi / 2, math.pi),
                               _arc(geometry.start, geometry.radius, along + math.pi / 2, math.pi)])
    if isinstance(geometry, Box):
        w, h = geometry.width / 2, geometry.height / 2
        return [(-w, -h), (w, -h), (w, h), (-w, h)]
    if isinstance(geometry, Segment):
        return [geometry.start, geometry.end]
    assert isinstance(geometry, Polygon)
    points = np.asarray(geometry.points)
    if geometry.radius == 0:
        return points
    sides = np.roll(points, -1, axis=0) - points
    facing = np.arctan2(sides[:, 1], sides[:, 0]) - math.pi / 2
    turns = (facing - np.roll(facing, 1)) % (2 * math.pi)
    return np.concatenate([_arc(point, geometry.radius, angle - turn, turn)
                           for point, angle, turn in zip(points, facing, turns)])
