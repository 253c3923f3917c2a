"""A physics engine to start from: one ball that falls and bounces off walls. Run it through the course with

    plumb check -- python3 docs/course/starters/ball.py

plumb sends one JSON object a line, and wants one back: docs/protocol.md. Chapter 1 passes; the rest is yours.
"""
import json
import sys
import time

HELLO = {
    "protocol": 1, "name": "ball", "version": "1", "precision": "double",
    "method": {"scheme": "semi_implicit_euler", "order": 1, "epsilon": 2.220446049250313e-16},
    "shapes": ["circle", "box"], "features": ["contacts"], "joints": [], "forces": [],
}


def why_not(scene):
    """What this engine cannot do about a scene; empty where it can."""
    moving = [body for body in scene["bodies"] if body["type"] == "dynamic"]
    if len(moving) != 1:
        return "only one body may move: go on with chapter 2"
    for body in scene["bodies"]:
        for shape in body["shapes"]:
            if shape["type"] != ("circle" if body in moving else "box"):
                return "the ball is a circle, and all else is boxes that stand still: go on with chapter 3"
            if body["angle"] or shape["angle"] or shape["friction"]:
                return "nothing is tilted or rough: go on with chapter 4"
    return ""


class Engine:
    def load(self, scene, settings):
        self.dt = settings["dt"]
        self.steps = 0
        self.gravity = scene["gravity"]
        self.bodies = scene["bodies"]
        self.ball = next(body for body in self.bodies if body["type"] == "dynamic")
        self.walls = [body for body in self.bodies if body is not self.ball]

    def step(self):
        position, velocity = self.ball["position"], self.ball["velocity"]
        for axis in (0, 1):
            velocity[axis] += self.gravity[axis] * self.dt  # the velocity first,
            position[axis] += velocity[axis] * self.dt  # then the position with the new velocity
        for wall in self.walls:
            for shape in wall["shapes"]:
                self.bounce(wall, shape)
        self.steps += 1

    def bounce(self, wall, box):
        position, velocity = self.ball["position"], self.ball["velocity"]
        circle = self.ball["shapes"][0]
        centre = [wall["position"][axis] + box["position"][axis] for axis in (0, 1)]
        half = [box["width"] / 2, box["height"] / 2]
        # The point of the box that is nearest to the ball's centre, and the way from there to the centre.
        nearest = [min(max(position[axis], centre[axis] - half[axis]), centre[axis] + half[axis]) for axis in (0, 1)]
        way = [position[axis] - nearest[axis] for axis in (0, 1)]
        distance = (way[0] ** 2 + way[1] ** 2) ** 0.5
        if distance >= circle["radius"] or distance == 0:
            return
        normal = [way[0] / distance, way[1] / distance]
        for axis in (0, 1):
            position[axis] += normal[axis] * (circle["radius"] - distance)  # out of the wall
        closing = velocity[0] * normal[0] + velocity[1] * normal[1]
        if closing >= 0:
            return  # it moves away already
        bounciness = max(circle["restitution"], box["restitution"])
        pull = (self.gravity[0] ** 2 + self.gravity[1] ** 2) ** 0.5
        if -closing <= 2 * pull * self.dt:
            bounciness = 0  # no more than what gravity added: it rests
        for axis in (0, 1):
            velocity[axis] -= (1 + bounciness) * closing * normal[axis]

    def states(self):
        rows = []
        for body in self.bodies:
            (x, y), (vx, vy) = body["position"], body["velocity"]
            rows.append([x, y, body["angle"] + body["angular_velocity"] * self.steps * self.dt, vx, vy,
                         body["angular_velocity"]])
        return rows


def main():
    engine = Engine()
    for line in sys.stdin:
        message = json.loads(line)
        if message["request"] == "hello":
            send(HELLO)
        elif message["request"] == "load":
            reason = why_not(message["scene"])
            if reason:
                send({"unsupported": reason})
                continue
            engine.load(message["scene"], message["settings"])
            send({"effective_settings": {"dt": engine.dt, "resting_speed": "2 g dt"}})
        elif message["request"] == "run":
            spent = 0
            for _ in range(message["samples"]):
                start = time.perf_counter_ns()
                for _ in range(message["every"]):
                    engine.step()
                spent += time.perf_counter_ns() - start
                send({"t": engine.steps * engine.dt, "states": engine.states()})
            send({"done": True, "ns": spent})
        elif message["request"] == "quit":
            return


def send(message):
    print(json.dumps(message), flush=True)


main()
