"""Chapter 3: circles that collide, on chapter 2's engine. See docs/course/3-circle-collisions.md.

    plumb check --chapter 3 -- python3 chapter3.py
    python3 chapter3.py --window
"""
import os
import sys

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "solved"))
import chapter2
from chapter1 import ROOM, ball
from chapter2 import Body
from plumb_engine import Vec, main

SWEEPS = 30  # times that each step goes over all contacts; one contact needs one, a pile needs many
SHARE = 0.5  # of an overlap that is removed a step: all at once makes piles tremble
SLOP = 0.0005  # m of overlap that is left, so that what rests stays in contact


class Contact:
    """Two bodies that touch: the normal has length 1 and points from a to b, the depth is the overlap in m."""

    def __init__(self, a, b, normal, depth, point):
        self.a, self.b, self.normal, self.depth, self.point = a, b, normal, depth, point
        self.bounce = 0.0  # m/s at which the two are to part
        self.total = 0.0  # N s, the sum of the step's impulses


class Engine(chapter2.Engine):
    hello = {**chapter2.Engine.hello, "name": "chapter 3"}

    def refuse(self, scene):
        for body in scene["bodies"]:
            if body["angular_velocity"] or any(shape["friction"] for shape in body["shapes"]):
                return "nothing turns or rubs: chapter 4"
            if len(body["shapes"]) != 1 or body["type"] == "kinematic":
                return "bodies have one shape, and are dynamic or static"
            if body["shapes"][0]["type"] == "box" and (body["angle"] or body["type"] == "dynamic"):
                return "boxes are static and upright: chapter 4 has others"
        return self.refuse_forces(scene)

    def step(self):
        self.accelerate()
        contacts = self.find_contacts()
        for contact in contacts:
            self.prepare(contact)
        for _ in range(SWEEPS):
            for contact in contacts:
                self.solve(contact)
        self.move()
        self.push_apart()
        self.steps += 1

    def find_contacts(self):
        contacts = []
        for i, a in enumerate(self.bodies):
            for b in self.bodies[i + 1:]:
                if a.moves or b.moves:
                    contacts += self.touch(a, b)
        return contacts

    def touch(self, a, b):
        """The contacts of two bodies, of which one at least is a circle."""
        if a.radius is None:
            a, b = b, a  # a is a circle
        if b.radius is None:
            return self.touch_box(a, b)
        reach = a.radius + b.radius
        # gap: return a list with a Contact if the centres are nearer than r1 + r2; the normal points from a to b
        way = b.position - a.position
        distance = way.length()
        if 0 < distance < reach:
            normal = way * (1 / distance)
            return [Contact(a, b, normal, reach - distance, a.position + normal * a.radius)]
        # end
        return []

    def touch_box(self, circle, box):
        nearest = box.nearest_to(circle.position)
        way = nearest - circle.position
        distance = way.length()
        if not 0 < distance < circle.radius:
            return []
        return [Contact(circle, box, way * (1 / distance), circle.radius - distance, nearest)]

    def closing(self, contact):
        """The speed along the normal at which b leaves a; below zero they close."""
        return (contact.b.velocity - contact.a.velocity).dot(contact.normal)

    def prepare(self, contact):
        speed = -self.closing(contact)
        contact.bounce = max(0.0, self.restitution(contact.a, contact.b, speed) * speed)

    def inverse_effective_mass(self, contact, direction):
        return contact.a.inverse_mass + contact.b.inverse_mass

    def apply_impulse(self, contact, impulse):
        """Gives b the impulse, in N s, and a the opposite one."""
        # gap: each velocity changes by the impulse times the inverse mass, a's in the opposite direction
        contact.a.velocity -= impulse * contact.a.inverse_mass
        contact.b.velocity += impulse * contact.b.inverse_mass
        # end

    def solve(self, contact):
        # gap: find the impulse that makes the speed along the normal equal to contact.bounce; add it to contact.total,
        # which never becomes negative; apply what the total has changed by
        j = (contact.bounce - self.closing(contact)) / self.inverse_effective_mass(contact, contact.normal)
        before = contact.total
        contact.total = max(0.0, before + j)
        self.apply_impulse(contact, contact.normal * (contact.total - before))
        # end

    def push_apart(self):
        for contact in self.find_contacts():
            a, b = contact.a, contact.b
            # gap: move the two apart by SHARE of (depth - SLOP), each by its share of the inverse masses
            push = SHARE * max(0.0, contact.depth - SLOP) / (a.inverse_mass + b.inverse_mass)
            a.position -= contact.normal * (push * a.inverse_mass)
            b.position += contact.normal * (push * b.inverse_mass)
            # end


if __name__ == "__main__":
    rack = [ball("ball%d%d" % (row, i), 1 + 0.42 * row, 3 + 0.5 * (i - row / 2), radius=0.24, restitution=0.95)
            for row in range(4) for i in range(row + 1)]
    main(Engine, {"gravity": [0, 0], "bodies": ROOM + rack + [ball("cue", -4, 3.05, vx=7, radius=0.24, restitution=0.95)]})
