"""Circles that fall, are pushed, and collide: an engine written from docs/protocol.md and docs/scene.md alone.

It does the first three chapters of the course: gravity, forces, drag, springs, circles against circles and against
boxes that stand still. Nothing turns and nothing rubs.
"""
import json
import math
import sys
import time

HELLO = {
    "protocol": 1,
    "name": "circles",
    "version": "1.0",
    "precision": "double",
    "method": {"scheme": "semi_implicit_euler", "order": 1, "epsilon": 2.220446049250313e-16},
    "shapes": ["circle", "box"],
    "forces": ["point_force", "linear_drag", "quadratic_drag", "spring"],
    "features": ["contacts"],
}
COMBINE = {
    "maximum": max,
    "minimum": min,
    "product": lambda a, b: a * b,
    "average": lambda a, b: (a + b) / 2,
    "geometric_mean": lambda a, b: math.sqrt(a * b),
}
SLOP = 0.001  # of a radius: what resting circles stay in each other


def why_not(scene):
    for body in scene["bodies"]:
        if body["type"] == "kinematic":
            return "nothing is kinematic here"
        if len(body["shapes"]) != 1:
            return f"body {body['name']!r} does not have one shape"
        shape = body["shapes"][0]
        if shape["type"] == "box" and (body["type"] == "dynamic" or body["angle"] or shape["angle"]):
            return "boxes stand still, upright"
        if shape["friction"] or any(shape["position"]) or body["angular_velocity"]:
            return "nothing rubs or turns here"
    for force in scene["forces"]:
        if any(force.get("point", [0, 0])) or force.get("frame", "world") != "world":
            return "forces act at the centre"
        if any(force.get("anchor_a", [0, 0])) and force["body_a"] != "world" or any(force.get("anchor_b", [0, 0])):
            return "springs hold centres"
    return ""


class Body:
    def __init__(self, scene):
        self.name = scene["name"]
        self.x, self.y = scene["position"]
        self.vx, self.vy = scene["velocity"]
        self.angle = scene["angle"]
        self.inverse_mass = 1 / scene["mass"] if scene["type"] == "dynamic" else 0
        self.shape = scene["shapes"][0]
        self.restitution = self.shape["restitution"]

    def push(self, px, py):
        self.vx += px * self.inverse_mass
        self.vy += py * self.inverse_mass


class Engine:
    def load(self, scene, settings):
        self.steps = 0
        self.substeps = settings.get("substeps", 1)
        self.dt = settings["dt"] / self.substeps
        self.gravity = scene["gravity"]
        self.bodies = [Body(body) for body in scene["bodies"]]
        self.by_name = {body.name: body for body in self.bodies}
        self.forces = scene["forces"]
        self.combine = COMBINE[scene["contact_rules"]["restitution"]]
        pull = math.hypot(*self.gravity)
        # What gravity adds in a step or two must not bounce.
        self.threshold = max(scene["contact_rules"]["restitution_threshold"], 2 * pull * self.dt)

    def force(self, law, t):
        """(body, fx, fy) for each body that the law pulls at."""
        if law["type"] == "spring":
            return self.spring(law)
        body = self.by_name[law["body"]]
        if law["type"] == "point_force":
            start, duration = law["start"], law.get("duration")
            if t < start - 1e-9 or (duration is not None and t >= start + duration - 1e-9):
                return []
            return [(body, *law["force"])]
        speed = math.hypot(body.vx, body.vy) if law["type"] == "quadratic_drag" else 1
        c = law["coefficient"] * speed
        return [(body, -c * body.vx, -c * body.vy)]

    def end(self, name, anchor):
        if name == "world":
            return None, anchor[0], anchor[1], 0, 0
        body = self.by_name[name]
        return body, body.x, body.y, body.vx, body.vy

    def spring(self, law):
        a, ax, ay, avx, avy = self.end(law["body_a"], law["anchor_a"])
        b, bx, by, bvx, bvy = self.end(law["body_b"], law["anchor_b"])
        length = math.hypot(bx - ax, by - ay)
        if length == 0:
            return []
        nx, ny = (bx - ax) / length, (by - ay) / length
        rate = (bvx - avx) * nx + (bvy - avy) * ny
        tension = law["stiffness"] * (length - law["rest_length"]) + law["damping"] * rate
        pulls = [(a, tension * nx, tension * ny), (b, -tension * nx, -tension * ny)]
        return [pull for pull in pulls if pull[0]]

    def touches(self):
        """(a, b, nx, ny, depth): circle a touches b, the normal points from a to b."""
        for i, a in enumerate(self.bodies):
            for b in self.bodies[i + 1:]:
                if a.inverse_mass + b.inverse_mass == 0:
                    continue
                if a.shape["type"] == "box":
                    a_, b_ = b, a
                else:
                    a_, b_ = a, b
                touch = self.touch(a_, b_)
                if touch:
                    yield touch

    def touch(self, a, b):
        r = a.shape["radius"]
        if b.shape["type"] == "circle":
            reach, x, y = r + b.shape["radius"], b.x, b.y
        else:
            w, h = b.shape["width"] / 2, b.shape["height"] / 2
            reach, x, y = r, min(max(a.x, b.x - w), b.x + w), min(max(a.y, b.y - h), b.y + h)
        d = math.hypot(x - a.x, y - a.y)
        if d >= reach or d == 0:
            return None
        return a, b, (x - a.x) / d, (y - a.y) / d, reach - d

    def step(self):
        t = self.steps * self.dt
        pulls = [pull for law in self.forces for pull in self.force(law, t)]
        for body, fx, fy in pulls:
            body.push(fx * self.dt, fy * self.dt)
        for body in self.bodies:
            if body.inverse_mass:
                body.vx += self.gravity[0] * self.dt
                body.vy += self.gravity[1] * self.dt
        self.collide()
        for body in self.bodies:
            if body.inverse_mass:
                body.x += body.vx * self.dt
                body.y += body.vy * self.dt
        for a, b, nx, ny, depth in list(self.touches()):
            share = 0.5 * max(0, depth - SLOP * a.shape["radius"]) / (a.inverse_mass + b.inverse_mass)
            a.x -= share * a.inverse_mass * nx
            a.y -= share * a.inverse_mass * ny
            b.x += share * b.inverse_mass * nx
            b.y += share * b.inverse_mass * ny
        self.steps += 1

    def collide(self):
        contacts = []
        for a, b, nx, ny, _ in self.touches():
            closing = (b.vx - a.vx) * nx + (b.vy - a.vy) * ny
            bounce = -self.combine(a.restitution, b.restitution) * closing if closing < -self.threshold else 0
            contacts.append([a, b, nx, ny, bounce, 0])
        for _ in range(20):
            for contact in contacts:
                a, b, nx, ny, bounce, total = contact
                closing = (b.vx - a.vx) * nx + (b.vy - a.vy) * ny
                j = (bounce - closing) / (a.inverse_mass + b.inverse_mass)
                contact[5] = max(0, total + j)  # contacts push, they never pull
                j = contact[5] - total
                a.push(-j * nx, -j * ny)
                b.push(j * nx, j * ny)


def send(message):
    print(json.dumps(message), flush=True)


def run(engine, samples, every):
    spent = 0
    for _ in range(samples):
        start = time.perf_counter_ns()
        for _ in range(every * engine.substeps):
            engine.step()
        spent += time.perf_counter_ns() - start
        states = [[b.x, b.y, b.angle, b.vx, b.vy, 0] for b in engine.bodies]
        send({"t": engine.steps * engine.dt, "states": states})
    send({"done": True, "ns": spent})


def main():
    engine = Engine()
    for line in sys.stdin:
        message = json.loads(line)
        request = message["request"]
        if request == "hello":
            send(HELLO)
        elif request == "load":
            reason = why_not(message["scene"])
            if reason:
                send({"unsupported": reason})
                continue
            engine.load(message["scene"], message["settings"])
            send({"effective_settings": {"dt": engine.dt, "threshold": engine.threshold}})
        elif request == "run":
            run(engine, message["samples"], message["every"])
        elif request == "quit":
            return


main()
