"""Connects an engine in Python to plumb, and shows it in a window. The physics is in chapter1.py to chapter5.py.

main(Engine, scene) speaks docs/protocol.md on standard input and output, which is what `plumb check`, `plumb compare`
and `plumb view` want; with --window it shows `scene` instead, moved by the engine (needs Debian's python3-tk).
"""
import json
import math
import sys
import time


class Vec:
    """A vector of the plane, in m, m/s or N."""

    __slots__ = ("x", "y")

    def __init__(self, x, y):
        self.x, self.y = x, y

    def __add__(self, other):
        return Vec(self.x + other.x, self.y + other.y)

    def __sub__(self, other):
        return Vec(self.x - other.x, self.y - other.y)

    def __mul__(self, factor):
        return Vec(self.x * factor, self.y * factor)

    def __neg__(self):
        return Vec(-self.x, -self.y)

    def dot(self, other):
        return self.x * other.x + self.y * other.y

    def cross(self, other):
        return self.x * other.y - self.y * other.x

    def length(self):
        return math.hypot(self.x, self.y)

    def turned(self, angle):
        """This vector turned counter-clockwise by `angle` rad."""
        c, s = math.cos(angle), math.sin(angle)
        return Vec(c * self.x - s * self.y, s * self.x + c * self.y)


COMBINE = {
    "maximum": max,
    "minimum": min,
    "product": lambda a, b: a * b,
    "average": lambda a, b: (a + b) / 2,
    "geometric_mean": lambda a, b: math.sqrt(a * b),
}


def send(message):
    print(json.dumps(message), flush=True)


def serve(engine_class):
    engine = None
    for line in sys.stdin:
        message = json.loads(line)
        request = message["request"]
        if request == "hello":
            send({"protocol": 1, "version": "1", "precision": "double",
                  "method": {"scheme": "semi_implicit_euler", "order": 1, "epsilon": 2.220446049250313e-16},
                  **engine_class.hello})
        elif request == "load":
            engine = engine_class()
            reason = engine.refuse(message["scene"])
            if reason:
                send({"unsupported": reason})
            else:
                engine.load(message["scene"], message["settings"]["dt"])
                send({"effective_settings": {"dt": engine.dt}})
        elif request == "run":
            spent = 0
            for _ in range(message["samples"]):
                start = time.perf_counter_ns()
                for _ in range(message["every"]):
                    engine.step()
                spent += time.perf_counter_ns() - start
                send({"t": engine.steps * engine.dt, "states": engine.states()})
            send({"done": True, "ns": spent})
        elif request == "quit":
            return


def filled_in(scene):
    """The scene with the defaults of docs/scene.md that the chapters use; plumb sends all of them."""
    scene = {"gravity": [0, -9.81], "joints": [], "forces": [],
             "contact_rules": {"restitution": "maximum", "friction": "geometric_mean", "restitution_threshold": 0}, **scene}
    bodies = []
    for body in scene["bodies"]:
        body = {"type": "dynamic", "position": [0, 0], "velocity": [0, 0], "angle": 0, "angular_velocity": 0, "mass": 1,
                "fixed_rotation": False, **body}
        body["shapes"] = [{"position": [0, 0], "angle": 0, "friction": 0.5, "restitution": 0, **shape}
                          for shape in body["shapes"]]
        bodies.append(body)
    scene["bodies"] = bodies
    return scene


def show(engine_class, scene, pixels_per_metre=80, seconds=None):
    """Opens a window in which the engine moves the scene, at real time, until it is closed or `seconds` are over."""
    import tkinter
    scene = filled_in(scene)
    width, height, dt = 960, 640, 1 / 60
    root = tkinter.Tk()
    root.title(engine_class.hello["name"])
    canvas = tkinter.Canvas(root, width=width, height=height, background="#f7f5f0", highlightthickness=0)
    canvas.pack()
    engine = engine_class()
    reason = engine.refuse(scene)
    if reason:
        raise SystemExit("this engine does not run the scene: " + reason)
    engine.load(scene, dt)

    def at(point):  # y points up in the scene and down in the window
        return width / 2 + pixels_per_metre * point.x, height - 60 - pixels_per_metre * point.y

    def draw():
        canvas.delete("all")
        for body, (x, y, angle, *_) in zip(scene["bodies"], engine.states()):
            fill = "#4c78a8" if body["type"] == "dynamic" else "#c9c4b8"
            shape, centre = body["shapes"][0], Vec(x, y)
            if shape["type"] == "circle":
                r = shape["radius"]
                canvas.create_oval(*at(centre - Vec(r, r)), *at(centre + Vec(r, r)), fill=fill, outline="#333333")
                canvas.create_line(*at(centre), *at(centre + Vec(r, 0).turned(angle)), fill="#ffffff")
            else:
                w, h = shape["width"] / 2, shape["height"] / 2
                corners = [centre + Vec(a * w, b * h).turned(angle) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                canvas.create_polygon([each for corner in corners for each in at(corner)], fill=fill, outline="#333333")
        canvas.create_text(12, 12, anchor="nw", text="%.2f s   space: start again" % (engine.steps * dt))

    def restart(_):
        nonlocal last, waiting
        engine.load(scene, dt)
        last, waiting = time.perf_counter(), 0.0

    def frame():
        nonlocal last, waiting
        now = time.perf_counter()
        waiting, last = min(waiting + now - last, 0.25), now
        while waiting >= dt:  # whole steps only: the motion is the same at any frame rate
            engine.step()
            waiting -= dt
        draw()
        if seconds is not None and engine.steps * dt >= seconds:
            root.destroy()
        else:
            root.after(15, frame)

    last, waiting = time.perf_counter(), 0.0
    root.bind("<space>", restart)
    frame()
    root.mainloop()


def main(engine_class, scene):
    if sys.argv[1:2] == ["--window"]:
        show(engine_class, scene, seconds=float(sys.argv[2]) if len(sys.argv) > 2 else None)
    elif sys.argv[1:]:
        raise SystemExit("usage: python3 %s [--window [SECONDS]]" % sys.argv[0])
    else:
        serve(engine_class)
