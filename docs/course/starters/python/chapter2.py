"""Chapter 2: forces and masses, on chapter 1's engine: a skeleton, solved/ has it filled in. See docs/course/2-cannonballs.md.

    plumb check --chapter 2 -- python3 chapter2.py
    python3 chapter2.py --window
"""
import os
import sys

sys.path.append(os.path.dirname(os.path.abspath(__file__)))
sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "solved"))
import chapter1
from chapter1 import ROOM, ball
from plumb_engine import Vec, main


class Body(chapter1.Body):
    def __init__(self, scene):
        super().__init__(scene)
        self.inverse_mass = 1 / scene["mass"] if self.moves else 0  # 1/kg
        self.force = Vec(0, 0)  # N, the sum of this step


class Engine(chapter1.Engine):
    hello = {**chapter1.Engine.hello, "name": "chapter 2", "forces": ["point_force", "linear_drag", "spring"]}
    body_class = Body

    def refuse(self, scene):
        for body in scene["bodies"]:
            if len(body["shapes"]) != 1 or body["type"] == "kinematic":
                return "bodies have one shape, and are dynamic or static"
            if body["shapes"][0]["type"] == "box" and body["type"] == "dynamic":
                return "boxes that move come in chapter 4"
        moving = [body for body in scene["bodies"] if body["type"] == "dynamic"]
        if len(moving) + sum(body["shapes"][0]["type"] == "circle" for body in scene["bodies"] if body not in moving) > 1 and (
                any(any(body["velocity"]) for body in moving) or any(body["type"] == "static" for body in scene["bodies"])):
            return "balls that may meet come in chapter 3"
        return self.refuse_forces(scene)

    def refuse_forces(self, scene):
        for law in scene["forces"]:
            if law["type"] == "point_force" and (any(law["point"]) or law["frame"] != "world"):
                return "forces act at the centre: chapter 4 has others"
            if law["type"] == "spring" and (law["body_a"] != "world" and any(law["anchor_a"]) or any(law["anchor_b"])):
                return "springs hold centres or the world: chapter 4 has others"
        return ""

    def load(self, scene, dt):
        super().load(scene, dt)
        self.laws = scene["forces"]
        self.by_name = {body.name: body for body in self.bodies}

    def accelerate(self):
        # TODO: set every body's sum of forces to zero
        pass
        for law in self.laws:
            self.apply(law)
        for body in self.bodies:
            if body.moves:
                # TODO: the acceleration is gravity plus the sum of forces over the mass; add it times dt to the velocity
                pass

    def apply(self, law):
        """Adds one law's force to its bodies' sums."""
        if law["type"] == "point_force":
            time = self.steps * self.dt
            ends = law["start"] + law.get("duration", float("inf"))
            # TODO: add law["force"] if law["start"] <= time < ends (less a rounding error)
            pass
        elif law["type"] == "linear_drag":
            body = self.by_name[law["body"]]
            # TODO: add the drag, -c v
            pass
        elif law["type"] == "spring":
            self.spring(law)

    def push(self, body, force, point):
        body.force += force

    def spring(self, law):
        """A spring between two ends, each a body or "world": a point that stands still, at its anchor."""
        ends = []
        for name, anchor in ((law["body_a"], law["anchor_a"]), (law["body_b"], law["anchor_b"])):
            body = self.by_name.get(name)
            ends.append((body, body.position if body else Vec(*anchor)))
        (a, at_a), (b, at_b) = ends
        way = at_b - at_a
        length = way.length()
        if length == 0:
            return
        direction = way * (1 / length)
        # TODO: the tension is k (length - rest length) + damping (speed at which the ends part); it pulls a along the
        # direction, and b against it
        pass


if __name__ == "__main__":
    main(Engine, {"bodies": [ball("light", -4, 4), ball("heavy", -4, 6, radius=0.6, mass=10)], "gravity": [0, -3],
                  "forces": [{"type": "point_force", "body": name, "force": [12, 20], "point": [0, 0], "frame": "world",
                              "start": 0.5, "duration": 0.5} for name in ("light", "heavy")]})
