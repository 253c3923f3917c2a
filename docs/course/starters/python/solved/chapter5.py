"""Chapter 5: sticks, hinges and a ragdoll, on chapter 4's engine. See docs/course/5-constraints-and-ragdoll.md.

    plumb check --chapter 5 -- python3 chapter5.py
    python3 chapter5.py --window
"""
import os
import sys

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "solved"))
import chapter4
from chapter1 import ROOM, ball
from chapter3 import SWEEPS
from chapter4 import box
from plumb_engine import Vec, main

CORRECTIONS = 8  # times that each step goes over the joints' errors of position
SHARE = 0.3  # of such an error that is removed each time


class World:
    """The end named "world": a body that stands still at the origin, so that its anchors are points of the world."""

    inverse_mass = inverse_inertia = 0.0

    def __init__(self):
        self.position, self.velocity, self.angle, self.spin = Vec(0, 0), Vec(0, 0), 0.0, 0.0

    def velocity_at(self, point):
        return Vec(0, 0)


class Joint:
    def __init__(self, scene, by_name):
        self.type = scene["type"]
        self.a, self.b = by_name[scene["body_a"]], by_name[scene["body_b"]]
        self.anchor_a, self.anchor_b = Vec(*scene["anchor_a"]), Vec(*scene["anchor_b"])
        self.length = scene.get("length")
        self.collide = scene.get("collide", False)

    def arms(self):
        """From each body's centre to its anchor, turned by the body's angle."""
        return self.anchor_a.turned(self.a.angle), self.anchor_b.turned(self.b.angle)

    def error(self):
        """The vector that must become zero: for a hinge from one anchor to the other, for a stick its excess of length."""
        arm_a, arm_b = self.arms()
        way = self.b.position + arm_b - self.a.position - arm_a
        if self.type == "revolute":
            return way
        # gap: for a stick, the way shortened by the length: way (|way| - length)/|way|
        distance = way.length()
        return way * ((distance - self.length) / distance)
        # end

    def directions(self):
        """The directions in which the joint holds: along the stick, or x and y of a hinge."""
        if self.type == "revolute":
            return [Vec(1, 0), Vec(0, 1)]
        arm_a, arm_b = self.arms()
        way = self.b.position + arm_b - self.a.position - arm_a
        return [way * (1 / way.length())]

    def inverse_effective_mass(self, arm_a, arm_b, n):
        a, b = self.a, self.b
        return (a.inverse_mass + b.inverse_mass + arm_a.cross(n) ** 2 * a.inverse_inertia +
                arm_b.cross(n) ** 2 * b.inverse_inertia)

    def solve(self):
        """Gives the bodies the impulses that make the anchors' relative speed zero."""
        a, b = self.a, self.b
        arm_a, arm_b = self.arms()
        for n in self.directions():
            # gap: the impulse is -speed/(inverse effective mass) along n, at the anchors: b gets it, a the opposite one
            speed = (b.velocity_at(b.position + arm_b) - a.velocity_at(a.position + arm_a)).dot(n)
            impulse = n * (-speed / self.inverse_effective_mass(arm_a, arm_b, n))
            a.velocity -= impulse * a.inverse_mass
            b.velocity += impulse * b.inverse_mass
            a.spin -= arm_a.cross(impulse) * a.inverse_inertia
            b.spin += arm_b.cross(impulse) * b.inverse_inertia
            # end

    def correct(self):
        """Moves the bodies so that SHARE of the error is gone."""
        error = self.error()
        size = error.length()
        if size == 0:
            return
        a, b = self.a, self.b
        arm_a, arm_b = self.arms()
        n = error * (1 / size)
        # gap: as in solve, but positions and angles move, by SHARE of the error
        push = n * (-SHARE * size / self.inverse_effective_mass(arm_a, arm_b, n))
        a.position -= push * a.inverse_mass
        b.position += push * b.inverse_mass
        a.angle -= arm_a.cross(push) * a.inverse_inertia
        b.angle += arm_b.cross(push) * b.inverse_inertia
        # end


class Engine(chapter4.Engine):
    hello = {**chapter4.Engine.hello, "name": "chapter 5", "joints": ["distance", "revolute"]}

    def load(self, scene, dt):
        super().load(scene, dt)
        ends = dict(self.by_name, world=World())
        self.joints = [Joint(joint, ends) for joint in scene["joints"]]
        self.apart = {pair for joint in self.joints if not joint.collide
                      for pair in ((joint.a, joint.b), (joint.b, joint.a))}  # joined bodies do not collide

    def touch(self, a, b):
        return [] if (a, b) in self.apart else super().touch(a, b)

    def step(self):
        self.accelerate()
        contacts = self.find_contacts()
        for contact in contacts:
            self.prepare(contact)
        for _ in range(SWEEPS):
            for joint in self.joints:
                joint.solve()
            for contact in contacts:
                self.solve(contact)
        self.move()
        self.push_apart()
        for _ in range(CORRECTIONS):
            for joint in self.joints:
                joint.correct()
        self.steps += 1


def hinge(a, b, anchor_a, anchor_b):
    return {"type": "revolute", "name": a + b, "body_a": a, "body_b": b, "anchor_a": anchor_a, "anchor_b": anchor_b}


if __name__ == "__main__":
    limbs = [("left arm", -0.45, 3.25, 0.5, 0.12), ("right arm", 0.45, 3.25, 0.5, 0.12), ("left leg", -0.15, 2.35, 0.12, 0.6),
             ("right leg", 0.15, 2.35, 0.12, 0.6)]
    main(Engine, {
        "bodies": [dict(wall, shapes=[dict(wall["shapes"][0], friction=0.5)]) for wall in ROOM] +
        [box("torso", 0, 3, 0.35, 0.7, mass=20), ball("head", 0, 3.52, radius=0.13, mass=4)] +
        [box(name, x, y, w, h, mass=5) for name, x, y, w, h in limbs],
        "joints": [hinge("torso", "head", [0, 0.37], [0, -0.15]), hinge("torso", "left arm", [-0.2, 0.25], [0.25, 0]),
                   hinge("torso", "right arm", [0.2, 0.25], [-0.25, 0]), hinge("torso", "left leg", [-0.15, -0.35], [0, 0.3]),
                   hinge("torso", "right leg", [0.15, -0.35], [0, 0.3])]})
