#!/usr/bin/env python3
"""An engine for all five chapters in one file, written from the course and docs/protocol.md alone.

    plumb check -- python3 tests/course/whole_engine.py

whole_engine_mistakes.py plants mistakes in it.
"""
import json, sys, time
from math import hypot, sin, cos, sqrt

HELLO = {"protocol": 1, "name": "mine", "version": "0.5", "precision": "double", "summary": "a learner's engine",
         "method": {"scheme": "semi_implicit_euler", "order": 1, "epsilon": 2.220446049250313e-16, "substeps": 1},
         "shapes": ["circle", "box"], "joints": ["distance", "revolute"],
         "forces": ["point_force", "linear_drag", "spring", "torque"],
         "features": ["contacts", "fixed_rotation"]}
SWEEPS, FIXES, SHARE, SLOP = 25, 8, 0.3, 0.0005


def rule(name, a, b):
    return {"maximum": max(a, b), "minimum": min(a, b), "product": a * b, "average": (a + b) / 2,
            "geometric_mean": sqrt(a * b)}[name]


def cross(ax, ay, bx, by):
    return ax * by - ay * bx


class Body:
    def __init__(self, b):
        self.dyn = b["type"] == "dynamic"
        self.x, self.y = b["position"]
        self.a = b["angle"]
        self.vx, self.vy = b["velocity"] if self.dyn else (0.0, 0.0)
        self.w = b["angular_velocity"] if self.dyn else 0.0
        self.im = 1 / b["mass"] if self.dyn else 0.0
        s = b["shapes"][0]
        self.e = s["restitution"]
        self.mu = s["friction"]
        self.r = s.get("radius")
        if self.r is None:
            self.hw, self.hh = s["width"] / 2, s["height"] / 2
            inertia = b["mass"] * (s["width"] ** 2 + s["height"] ** 2) / 12
        else:
            inertia = b["mass"] * self.r ** 2 / 2
        self.ii = 1 / inertia if self.dyn and not b["fixed_rotation"] else 0.0

    def point(self, px, py):
        c, s = cos(self.a), sin(self.a)
        return c * px - s * py, s * px + c * py

    def local(self, wx, wy):
        c, s = cos(self.a), sin(self.a)
        dx, dy = wx - self.x, wy - self.y
        return c * dx + s * dy, -s * dx + c * dy

    def velocity(self, rx, ry):
        return self.vx - self.w * ry, self.vy + self.w * rx

    def impulse(self, jx, jy, rx, ry):
        self.vx += jx * self.im
        self.vy += jy * self.im
        self.w += cross(rx, ry, jx, jy) * self.ii

    def shift(self, jx, jy, rx, ry):
        self.x += jx * self.im
        self.y += jy * self.im
        self.a += cross(rx, ry, jx, jy) * self.ii


class Point:
    """A body's or the world's point."""

    def __init__(self, body, x, y):
        self.body, self.px, self.py = body, x, y

    def arm(self):
        return self.body.point(self.px, self.py)


WORLD = Body({"type": "static", "position": [0, 0], "angle": 0, "velocity": [0, 0], "angular_velocity": 0, "mass": 1,
              "fixed_rotation": False, "shapes": [{"type": "circle", "radius": 1, "restitution": 0, "friction": 0}]})


def inverse_mass(a, b, rax, ray, rbx, rby, nx, ny):
    return (a.im + b.im + cross(rax, ray, nx, ny) ** 2 * a.ii + cross(rbx, rby, nx, ny) ** 2 * b.ii)


class World:
    def __init__(self, scene, dt):
        self.dt, self.n = dt, 0
        self.g = scene["gravity"]
        self.rules = scene["contact_rules"]
        self.bodies = [Body(b) for b in scene["bodies"]]
        self.names = {b["name"]: self.bodies[i] for i, b in enumerate(scene["bodies"])}
        self.names["world"] = WORLD
        self.forces = scene["forces"]
        self.joints = []
        self.joined = set()
        for j in scene["joints"]:
            a, b = self.names[j["body_a"]], self.names[j["body_b"]]
            self.joints.append((Point(a, *j["anchor_a"]), Point(b, *j["anchor_b"]),
                                j["length"] if j["type"] == "distance" else None))
            if not j["collide"]:
                self.joined.add((id(a), id(b)))
                self.joined.add((id(b), id(a)))

    def apply_forces(self):
        t, h = self.n * self.dt, self.dt
        for b in self.bodies:
            b.fx = b.fy = b.torque = 0.0
        WORLD.fx = WORLD.fy = WORLD.torque = 0.0
        for f in self.forces:
            start = f.get("start", 0)
            if t < start - 1e-12 or t >= start + f.get("duration", 1e300) - 1e-12:
                continue
            k = f["type"]
            if k == "point_force":
                b = self.names[f["body"]]
                rx, ry = b.point(*f["point"])
                fx, fy = f["force"] if f["frame"] == "world" else b.point(*f["force"])
                self.push(b, fx, fy, rx, ry)
            elif k == "torque":
                self.names[f["body"]].torque += f["torque"]
            elif k == "linear_drag":
                b = self.names[f["body"]]
                b.fx -= f["coefficient"] * b.vx
                b.fy -= f["coefficient"] * b.vy
            elif k == "spring":
                a, b = self.names[f["body_a"]], self.names[f["body_b"]]
                rax, ray = a.point(*f["anchor_a"])
                rbx, rby = b.point(*f["anchor_b"])
                dx, dy = b.x + rbx - a.x - rax, b.y + rby - a.y - ray
                length = hypot(dx, dy)
                dx, dy = dx / length, dy / length
                avx, avy = a.velocity(rax, ray)
                bvx, bvy = b.velocity(rbx, rby)
                rate = (bvx - avx) * dx + (bvy - avy) * dy
                force = f["stiffness"] * (length - f["rest_length"]) + f["damping"] * rate
                self.push(a, force * dx, force * dy, rax, ray)
                self.push(b, -force * dx, -force * dy, rbx, rby)
        for b in self.bodies:
            if b.dyn:
                b.vx += (self.g[0] + b.fx * b.im) * h
                b.vy += (self.g[1] + b.fy * b.im) * h
                b.w += b.torque * b.ii * h

    def push(self, b, fx, fy, rx, ry):
        b.fx += fx
        b.fy += fy
        b.torque += cross(rx, ry, fx, fy)

    def pairs(self):
        for i, a in enumerate(self.bodies):
            for b in self.bodies[i + 1:]:
                if (a.dyn or b.dyn) and (id(a), id(b)) not in self.joined:
                    yield a, b

    def contacts(self):
        found = []
        for a, b in self.pairs():
            for nx, ny, depth, px, py in self.touch(a, b):
                rax, ray, rbx, rby = px - a.x, py - a.y, px - b.x, py - b.y
                c = {"a": a, "b": b, "n": (nx, ny), "depth": depth, "ra": (rax, ray), "rb": (rbx, rby), "sum": 0.0, "rub": 0.0}
                c["mu"] = rule(self.rules["friction"], a.mu, b.mu)
                e = rule(self.rules["restitution"], a.e, b.e)
                vx, vy = self.relative(c)
                vn = vx * nx + vy * ny
                slow = max(2 * hypot(*self.g) * self.dt, self.rules["restitution_threshold"])
                c["bounce"] = -e * vn if vn < -slow else 0.0
                c["k"] = inverse_mass(a, b, rax, ray, rbx, rby, nx, ny)
                c["kt"] = inverse_mass(a, b, rax, ray, rbx, rby, -ny, nx)
                found.append(c)
        return found

    def touch(self, a, b):
        if a.r is not None and b.r is not None:
            dx, dy = b.x - a.x, b.y - a.y
            d = hypot(dx, dy)
            if 0 < d < a.r + b.r:
                nx, ny = dx / d, dy / d
                return [(nx, ny, a.r + b.r - d, a.x + nx * a.r, a.y + ny * a.r)]
            return []
        if a.r is None and b.r is None:
            return self.touch_boxes(a, b)
        if a.r is None:
            return [(-nx, -ny, d, px, py) for nx, ny, d, px, py in self.touch(b, a)]
        lx, ly = b.local(a.x, a.y)
        px, py = min(max(lx, -b.hw), b.hw), min(max(ly, -b.hh), b.hh)
        wx, wy = b.point(px, py)
        wx, wy = wx + b.x, wy + b.y
        dx, dy = wx - a.x, wy - a.y
        d = hypot(dx, dy)
        if 0 < d < a.r:
            return [(dx / d, dy / d, a.r - d, wx, wy)]
        return []

    def touch_boxes(self, a, b):
        best = None
        dx, dy = b.x - a.x, b.y - a.y
        for box in (a, b):
            for lx, ly in ((1, 0), (0, 1)):
                nx, ny = box.point(lx, ly)
                overlap = self.extent(a, nx, ny) + self.extent(b, nx, ny) - abs(dx * nx + dy * ny)
                if overlap <= 0:
                    return []
                if best is None or overlap < best[0] - 1e-9:
                    best = (overlap, box, nx, ny, box.hw if lx else box.hh, box.hh if lx else box.hw)
        overlap, face, nx, ny, reach, half = best
        if dx * nx + dy * ny < 0:
            nx, ny = -nx, -ny
        # out: the direction of the face, away from its own box
        out = (nx, ny) if face is a else (-nx, -ny)
        other = b if face is a else a
        corners = []
        for sx, sy in ((1, 1), (1, -1), (-1, -1), (-1, 1)):
            cx, cy = other.point(sx * other.hw, sy * other.hh)
            corners.append((other.x + cx, other.y + cy))
        corners.sort(key=lambda p: (p[0] - face.x) * out[0] + (p[1] - face.y) * out[1])
        (p1x, p1y), (p2x, p2y) = corners[:2]
        tx, ty = -out[1], out[0]
        s1 = (p1x - face.x) * tx + (p1y - face.y) * ty
        s2 = (p2x - face.x) * tx + (p2y - face.y) * ty
        points = []
        for s in sorted((s1, s2)):
            s = min(max(s, -half), half)
            f = 0.5 if s1 == s2 else (s - s1) / (s2 - s1)
            px, py = p1x + f * (p2x - p1x), p1y + f * (p2y - p1y)
            depth = reach - ((px - face.x) * out[0] + (py - face.y) * out[1])
            if depth > 0:
                points.append((nx, ny, depth, px, py))
        return points

    @staticmethod
    def extent(box, nx, ny):
        xx, xy = box.point(1, 0)
        yx, yy = box.point(0, 1)
        return box.hw * abs(nx * xx + ny * xy) + box.hh * abs(nx * yx + ny * yy)

    @staticmethod
    def relative(c):
        avx, avy = c["a"].velocity(*c["ra"])
        bvx, bvy = c["b"].velocity(*c["rb"])
        return bvx - avx, bvy - avy

    def apply(self, c, jx, jy):
        c["a"].impulse(-jx, -jy, *c["ra"])
        c["b"].impulse(jx, jy, *c["rb"])

    def solve_contact(self, c):
        nx, ny = c["n"]
        vx, vy = self.relative(c)
        j = (c["bounce"] - (vx * nx + vy * ny)) / c["k"]
        new = max(0.0, c["sum"] + j)
        j, c["sum"] = new - c["sum"], new
        self.apply(c, j * nx, j * ny)
        tx, ty = -ny, nx
        vx, vy = self.relative(c)
        j = -(vx * tx + vy * ty) / c["kt"]
        most = c["mu"] * c["sum"]
        new = min(max(c["rub"] + j, -most), most)
        j, c["rub"] = new - c["rub"], new
        self.apply(c, j * tx, j * ty)

    def solve_joint(self, joint):
        p, q, length = joint
        a, b = p.body, q.body
        rax, ray = p.arm()
        rbx, rby = q.arm()
        if length is None:
            axes = ((1.0, 0.0), (0.0, 1.0))
        else:
            dx, dy = b.x + rbx - a.x - rax, b.y + rby - a.y - ray
            d = hypot(dx, dy)
            axes = ((dx / d, dy / d),)
        for nx, ny in axes:
            avx, avy = a.velocity(rax, ray)
            bvx, bvy = b.velocity(rbx, rby)
            rate = (bvx - avx) * nx + (bvy - avy) * ny
            j = -rate / inverse_mass(a, b, rax, ray, rbx, rby, nx, ny)
            a.impulse(-j * nx, -j * ny, rax, ray)
            b.impulse(j * nx, j * ny, rbx, rby)

    def fix_joint(self, joint):
        p, q, length = joint
        a, b = p.body, q.body
        rax, ray = p.arm()
        rbx, rby = q.arm()
        dx, dy = b.x + rbx - a.x - rax, b.y + rby - a.y - ray
        d = hypot(dx, dy)
        error = d if length is None else d - length
        if d == 0:
            return
        nx, ny = dx / d, dy / d
        push = SHARE * error / inverse_mass(a, b, rax, ray, rbx, rby, nx, ny)
        a.shift(push * nx, push * ny, rax, ray)
        b.shift(-push * nx, -push * ny, rbx, rby)

    def step(self):
        self.apply_forces()
        found = self.contacts()
        for _ in range(SWEEPS):
            for joint in self.joints:
                self.solve_joint(joint)
            for c in found:
                self.solve_contact(c)
        for b in self.bodies:
            if b.dyn:
                b.x += b.vx * self.dt
                b.y += b.vy * self.dt
                b.a += b.w * self.dt
        for _ in range(FIXES):
            for joint in self.joints:
                self.fix_joint(joint)
        for a, b in self.pairs():
            for nx, ny, depth, px, py in self.touch(a, b):
                rax, ray, rbx, rby = px - a.x, py - a.y, px - b.x, py - b.y
                push = SHARE * max(0.0, depth - SLOP) / inverse_mass(a, b, rax, ray, rbx, rby, nx, ny)
                a.shift(-push * nx, -push * ny, rax, ray)
                b.shift(push * nx, push * ny, rbx, rby)
        self.n += 1


def main():
    world = None
    for line in sys.stdin:
        q = json.loads(line)
        if q["request"] == "hello":
            out(HELLO)
        elif q["request"] == "load":
            world = World(q["scene"], q["settings"]["dt"])
            out({"effective_settings": {"dt": world.dt}})
        elif q["request"] == "run":
            t0 = time.perf_counter_ns()
            for _ in range(q["samples"]):
                for _ in range(q["every"]):
                    world.step()
                out({"t": world.n * world.dt, "states": [[b.x, b.y, b.a, b.vx, b.vy, b.w] for b in world.bodies]})
            out({"done": True, "ns": time.perf_counter_ns() - t0})
        elif q["request"] == "quit":
            return


def out(o):
    print(json.dumps(o), flush=True)


main()
