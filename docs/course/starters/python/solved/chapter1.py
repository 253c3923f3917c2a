"""Chapter 1: a ball falls, bounces off walls and comes to rest. See docs/course/1-bouncing-ball.md.

    plumb check --chapter 1 -- python3 chapter1.py
    python3 chapter1.py --window
"""
import os
import sys

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from plumb_engine import COMBINE, Vec, main


class Body:
    def __init__(self, scene):
        self.name = scene["name"]
        self.moves = scene["type"] == "dynamic"
        self.position, self.velocity = Vec(*scene["position"]), Vec(*scene["velocity"])
        self.angle, self.spin = scene["angle"], scene["angular_velocity"]
        shape = scene["shapes"][0]
        self.restitution = shape["restitution"]
        self.radius = shape["radius"] if shape["type"] == "circle" else None  # m; None: a box
        self.half = Vec(shape["width"] / 2, shape["height"] / 2) if self.radius is None else None  # m

    def nearest_to(self, point):
        """The point of this upright box that is nearest to `point`."""
        low, high = self.position - self.half, self.position + self.half
        return Vec(min(max(point.x, low.x), high.x), min(max(point.y, low.y), high.y))


class Engine:
    hello = {"name": "chapter 1", "shapes": ["circle", "box"], "features": ["contacts"]}
    body_class = Body

    def refuse(self, scene):
        """Why this engine cannot run the scene; empty if it can."""
        moving = [body for body in scene["bodies"] if body["type"] != "static"]
        if len(moving) != 1 or moving[0]["type"] != "dynamic":
            return "one ball moves: several come in chapter 2"
        for body in scene["bodies"]:
            if len(body["shapes"]) != 1 or body["shapes"][0]["type"] != ("circle" if body in moving else "box"):
                return "a ball between static boxes: other shapes come in chapters 3 and 4"
            if body["angle"] or body["angular_velocity"] or body["shapes"][0]["friction"]:
                return "nothing turns or rubs: chapter 4"
        return "forces come in chapter 2" if scene["forces"] else ""

    def load(self, scene, dt):
        self.dt, self.steps = dt, 0
        self.gravity = Vec(*scene["gravity"])
        self.rules = scene["contact_rules"]
        self.bodies = [self.body_class(body) for body in scene["bodies"]]

    def step(self):
        self.accelerate()
        self.move()
        for ball in self.bodies:
            for wall in self.bodies:
                if ball.moves and not wall.moves:
                    self.bounce(ball, wall)
        self.steps += 1

    def accelerate(self):
        for body in self.bodies:
            if body.moves:
                # gap: add gravity times dt to the velocity
                body.velocity += self.gravity * self.dt
                # end

    def move(self):
        for body in self.bodies:
            if body.moves:
                # gap: add the new velocity times dt to the position
                body.position += body.velocity * self.dt
                # end

    def bounce(self, ball, wall):
        way = ball.position - wall.nearest_to(ball.position)  # from the wall to the ball's centre
        distance = way.length()
        if distance >= ball.radius or distance == 0:
            return
        # gap: 1. find the normal, which has length 1; 2. move the ball out of the wall; 3. if it moves towards the
        # wall, turn the velocity's part along the normal round and scale that part by the restitution
        normal = way * (1 / distance)
        ball.position += normal * (ball.radius - distance)
        closing = ball.velocity.dot(normal)
        if closing < 0:
            ball.velocity -= normal * ((1 + self.restitution(ball, wall, -closing)) * closing)
        # end

    def restitution(self, a, b, speed):
        """The share of the closing speed that comes back; 0 for a speed that gravity gives within two steps."""
        if speed <= max(2 * self.gravity.length() * self.dt, self.rules["restitution_threshold"]):
            return 0
        return COMBINE[self.rules["restitution"]](a.restitution, b.restitution)

    def states(self):
        return [[b.position.x, b.position.y, b.angle, b.velocity.x, b.velocity.y, b.spin] for b in self.bodies]


def wall(name, x, y, width, height):
    return {"name": name, "type": "static", "position": [x, y],
            "shapes": [{"type": "box", "width": width, "height": height, "friction": 0}]}


ROOM = [wall("floor", 0, -0.25, 10, 0.5), wall("ceiling", 0, 6.25, 10, 0.5), wall("left", -5.25, 3, 0.5, 7),
        wall("right", 5.25, 3, 0.5, 7)]


def ball(name, x, y, vx=0, vy=0, radius=0.4, mass=1, restitution=0.8):
    return {"name": name, "position": [x, y], "velocity": [vx, vy], "mass": mass,
            "shapes": [{"type": "circle", "radius": radius, "restitution": restitution, "friction": 0}]}


if __name__ == "__main__":
    main(Engine, {"bodies": ROOM + [ball("ball", -3, 4, 4, 2)]})
