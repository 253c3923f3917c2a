"""Chapter 4: boxes, rotation and friction, on chapter 3's engine. See docs/course/4-rotation-and-boxes.md.

    plumb check --chapter 4 -- python3 chapter4.py
    python3 chapter4.py --window
"""
import os
import sys

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "solved"))
import chapter2
import chapter3
from chapter1 import ROOM
from chapter3 import Contact
from plumb_engine import COMBINE, Vec, main


class Body(chapter2.Body):
    def __init__(self, scene):
        super().__init__(scene)
        self.friction = scene["shapes"][0]["friction"]
        self.torque = 0.0  # N m, the sum of this step
        mass, inertia = scene["mass"], scene.get("inertia")
        # gap: the inertia of a disc is m r^2/2, that of a box m (width^2 + height^2)/12; self.half has half of each side
        if inertia is None and self.radius is not None:
            inertia = mass * self.radius ** 2 / 2
        elif inertia is None:
            inertia = mass * (4 * self.half.x ** 2 + 4 * self.half.y ** 2) / 12
        # end
        turns = self.moves and inertia and not scene["fixed_rotation"]
        self.inverse_inertia = 1 / inertia if turns else 0.0  # 1/(kg m^2)

    def axes(self):
        """The directions of a box's width and height."""
        return Vec(1, 0).turned(self.angle), Vec(0, 1).turned(self.angle)

    def corners(self):
        x, y = self.axes()
        w, h = x * self.half.x, y * self.half.y
        return [self.position - w - h, self.position + w - h, self.position + w + h, self.position - w + h]

    def velocity_at(self, point):
        # gap: a point at r from the centre moves with v + w x r; w x r is (-w r.y, w r.x)
        r = point - self.position
        return self.velocity + Vec(-self.spin * r.y, self.spin * r.x)
        # end

    def nearest_to(self, point):
        local = (point - self.position).turned(-self.angle)
        clamped = Vec(min(max(local.x, -self.half.x), self.half.x), min(max(local.y, -self.half.y), self.half.y))
        return self.position + clamped.turned(self.angle)


class Engine(chapter3.Engine):
    hello = {**chapter3.Engine.hello, "name": "chapter 4", "features": ["contacts", "fixed_rotation"],
             "forces": ["point_force", "linear_drag", "spring", "torque"]}
    body_class = Body

    def refuse(self, scene):
        for body in scene["bodies"]:
            if len(body["shapes"]) != 1 or body["type"] == "kinematic":
                return "bodies have one shape, and are dynamic or static"
        for law in scene["forces"]:
            if law["type"] == "point_force" and law["frame"] != "world":
                return "forces keep their direction in the world"
            if law["type"] == "spring" and (law["body_a"] != "world" and any(law["anchor_a"]) or any(law["anchor_b"])):
                return "springs hold centres or the world"
        return ""

    def accelerate(self):
        for body in self.bodies:
            body.torque = 0.0
        super().accelerate()
        for body in self.bodies:
            # gap: the spin grows by torque dt/I
            body.spin += body.torque * body.inverse_inertia * self.dt
            # end

    def apply(self, law):
        if law["type"] == "torque":
            time = self.steps * self.dt
            if law["start"] - 1e-9 <= time < law["start"] + law.get("duration", float("inf")) - 1e-9:
                self.by_name[law["body"]].torque += law["torque"]
        else:
            super().apply(law)

    def push(self, body, force, point):
        body.force += force
        # gap: turn the point by the body's angle: that is the arm r; add the torque r x F
        arm = Vec(*point).turned(body.angle)
        body.torque += arm.cross(force)
        # end

    def move(self):
        super().move()
        for body in self.bodies:
            if body.moves:
                # gap: add the spin times dt to the angle
                body.angle += body.spin * self.dt
                # end

    def touch(self, a, b):
        if a.radius is None and b.radius is None:
            return self.touch_boxes(a, b)
        return super().touch(a, b)

    def touch_boxes(self, a, b):
        """Separating axes, then clipping: up to two contacts."""
        least, face_of, normal = None, None, None
        way = b.position - a.position
        for box in (a, b):
            for axis in box.axes():
                # gap: how far do the two overlap along the axis? Half of each one's extent there, less the distance of
                # the centres; if it is not above 0 return []; keep the least in `least`, its box in `face_of` and its
                # axis, turned so that it points from a to b, in `normal`
                overlap = self.extent(a, axis) + self.extent(b, axis) - abs(way.dot(axis))
                if overlap <= 0:
                    return []
                if least is None or overlap < least - 1e-9:
                    least, face_of, normal = overlap, box, axis if way.dot(axis) > 0 else -axis
                # end
        if normal is None:
            return []
        other, out = (b, normal) if face_of is a else (a, -normal)  # out of the box with the face
        # The other box's side that faces the face: its two corners farthest in.
        ends = sorted(other.corners(), key=lambda corner: corner.dot(out))[:2]
        # Clip that side at the face's two ends.
        along = Vec(-out.y, out.x)
        half = self.extent(face_of, along)
        for side in (along, -along):
            limit = face_of.position.dot(side) + half
            ends = self.clip(ends, side, limit)
        face = face_of.position.dot(out) + self.extent(face_of, out)
        contacts = []
        for point in ends:
            depth = face - point.dot(out)
            if depth > 0:
                contacts.append(Contact(a, b, normal, depth, point))
        return contacts

    @staticmethod
    def extent(box, axis):
        """Half of the box's extent along the axis."""
        x, y = box.axes()
        return box.half.x * abs(x.dot(axis)) + box.half.y * abs(y.dot(axis))

    @staticmethod
    def clip(ends, side, limit):
        """The part of the line between two ends where point . side <= limit."""
        inside = [end for end in ends if end.dot(side) <= limit]
        if len(ends) == 2 and len(inside) == 1:
            d0, d1 = ends[0].dot(side) - limit, ends[1].dot(side) - limit
            inside.append(ends[0] + (ends[1] - ends[0]) * (d0 / (d0 - d1)))
        return inside

    def velocity_apart(self, contact):
        return contact.b.velocity_at(contact.point) - contact.a.velocity_at(contact.point)

    def closing(self, contact):
        return self.velocity_apart(contact).dot(contact.normal)

    def prepare(self, contact):
        super().prepare(contact)
        contact.friction = COMBINE[self.rules["friction"]](contact.a.friction, contact.b.friction)
        contact.total_across = 0.0

    def inverse_effective_mass(self, contact, direction):
        # gap: 1/ma + 1/mb + (ra x n)^2/Ia + (rb x n)^2/Ib
        a, b = contact.a, contact.b
        arm_a = (contact.point - a.position).cross(direction)
        arm_b = (contact.point - b.position).cross(direction)
        return a.inverse_mass + b.inverse_mass + arm_a ** 2 * a.inverse_inertia + arm_b ** 2 * b.inverse_inertia
        # end

    def apply_impulse(self, contact, impulse):
        super().apply_impulse(contact, impulse)
        # gap: each spin changes by (r x impulse)/I, a's by the opposite impulse
        a, b = contact.a, contact.b
        a.spin -= (contact.point - a.position).cross(impulse) * a.inverse_inertia
        b.spin += (contact.point - b.position).cross(impulse) * b.inverse_inertia
        # end

    def solve(self, contact):
        super().solve(contact)
        # gap: friction. Along the tangent, find the impulse that stops the sliding; its sum stays within
        # -friction * total and +friction * total of the impulse along the normal
        tangent = Vec(-contact.normal.y, contact.normal.x)
        sliding = self.velocity_apart(contact).dot(tangent)
        j = -sliding / self.inverse_effective_mass(contact, tangent)
        before, most = contact.total_across, contact.friction * contact.total
        contact.total_across = min(max(before + j, -most), most)
        self.apply_impulse(contact, tangent * (contact.total_across - before))
        # end


def box(name, x, y, width, height, angle=0, mass=1):
    return {"name": name, "position": [x, y], "angle": angle, "mass": mass,
            "shapes": [{"type": "box", "width": width, "height": height, "restitution": 0.2}]}


if __name__ == "__main__":
    main(Engine, {"bodies": [dict(wall, shapes=[dict(wall["shapes"][0], friction=0.5)]) for wall in ROOM] + [
        box("square", -2, 3, 0.8, 0.8, angle=0.4), box("plank", 0, 2, 2, 0.3, angle=-0.3), box("brick", 1.5, 4, 1.2, 0.6)]})
