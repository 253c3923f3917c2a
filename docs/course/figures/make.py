#!/usr/bin/env python3
"""Draws the figures of the course from runs of plumb and of the tests' learner's engine, which makes mistakes on demand.

usage: make.py [BUILD [FOLDER]]   BUILD is build/release, FOLDER this one; builds must have plumb and plumb_course_student
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

import drawings

HERE = pathlib.Path(__file__).resolve().parent
COLOURS = ["#00468b", "#d95f02", "#2a9d5c", "#7a3b9d"]
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 640, 300, 62, 16, 44, 44


def ball(name, position, velocity=(0, 0), mass=1, radius=0.5, restitution=1):
    shape = {"type": "circle", "radius": radius, "restitution": restitution, "friction": 0}
    return {"name": name, "position": list(position), "velocity": list(velocity), "mass": mass, "shapes": [shape]}


def box(name, position, width, height, **more):
    shape = {"type": "box", "width": width, "height": height, "restitution": 1, "friction": 0}
    return {"name": name, "position": list(position), "shapes": [shape], **more}


def scene(bodies, gravity=(0, 0), **more):
    return {"plumb_scene": 1, "gravity": list(gravity), "bodies": bodies, **more}


class Runs:
    """Rows (t, {body: (x, y, angle, vx, vy, w)}) of a scene, by plumb or by the learner's engine."""

    def __init__(self, build):
        self.plumb = build / "bin/plumb"
        self.student = build / "tests/plumb_course_student"

    def by_plumb(self, scene, seconds, **options):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(scene, file)
            file.flush()
            command = [self.plumb, "run", file.name, "--substeps", "1", "--duration", str(seconds)]
            for option in options.items():
                command += ["--set", "=".join(option)]
            text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        rows = {}
        for line in text.splitlines()[1:]:
            t, name, *numbers = line.split(",")
            rows.setdefault(float(t), {})[name] = [float(number) for number in numbers]
        return sorted(rows.items())

    def by_student(self, scene, seconds, mistake=""):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump(scene, file)
            file.flush()
            checked = json.loads(subprocess.run([self.plumb, "scene", file.name], check=True, capture_output=True,
                                                text=True).stdout)
        steps = round(seconds * 60)
        requests = [{"request": "hello", "protocol": 1},
                    {"request": "load", "scene": checked, "settings": {"dt": 1 / 60, "options": {}}},
                    {"request": "run", "samples": steps, "every": 1}, {"request": "quit"}]
        lines = subprocess.run([self.student, mistake], check=True, capture_output=True, text=True,
                               input="".join(json.dumps(each) + "\n" for each in requests)).stdout.splitlines()
        names = [body["name"] for body in checked["bodies"]]
        first = [body["position"] + [body["angle"]] + body["velocity"] + [body["angular_velocity"]]
                 for body in checked["bodies"]]
        rows = [{"t": 0, "states": first}, *map(json.loads, lines[2:-1])]
        return [(row["t"], dict(zip(names, row["states"]))) for row in rows]


def nice_ticks(low, high):
    span = high - low
    step = 10 ** math.floor(math.log10(span / 4))
    step *= min((factor for factor in (1, 2, 5, 10) if span / (factor * step) <= 6))
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def draw(path, title, x_name, y_name, curves, y_range=None):
    """`curves`: (name, [(x, y)...]); a picture of lines with axes and a legend."""
    points = [point for _, curve in curves for point in curve]
    x0, x1 = min(x for x, _ in points), max(x for x, _ in points)
    y0, y1 = y_range or (min(y for _, y in points), max(y for _, y in points))
    if not y_range:
        y0, y1 = y0 - 0.05 * (y1 - y0), y1 + 0.05 * (y1 - y0)
    at_x = lambda x: LEFT + (x - x0) / (x1 - x0) * (WIDTH - LEFT - RIGHT)
    at_y = lambda y: HEIGHT - BOTTOM - (y - y0) / (y1 - y0) * (HEIGHT - TOP - BOTTOM)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
           f'font-size="12"><rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
           f'<text x="{LEFT}" y="18" font-size="14" fill="#222222">{title}</text>']
    for x in nice_ticks(x0, x1):
        out.append(f'<path d="M{at_x(x):.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="#e4e4e4"/>'
                   f'<text x="{at_x(x):.1f}" y="{HEIGHT - BOTTOM + 16}" text-anchor="middle" fill="#444444">{x:g}</text>')
    for y in nice_ticks(y0, y1):
        out.append(f'<path d="M{LEFT} {at_y(y):.1f}H{WIDTH - RIGHT}" stroke="#e4e4e4"/>'
                   f'<text x="{LEFT - 6}" y="{at_y(y) + 4:.1f}" text-anchor="end" fill="#444444">{y:g}</text>')
    out.append(f'<text x="{WIDTH - RIGHT}" y="{HEIGHT - 8}" text-anchor="end" fill="#444444">{x_name}</text>'
               f'<text x="8" y="{TOP - 8}" fill="#444444">{y_name}</text>')
    out.append(f'<clipPath id="plot"><rect x="{LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" '
               f'height="{HEIGHT - TOP - BOTTOM}"/></clipPath>')
    key = WIDTH - RIGHT
    for (name, curve), colour in reversed(list(zip(curves, COLOURS))):
        path_text = "L".join(f"{at_x(x):.1f} {at_y(y):.1f}" for x, y in curve)
        out.append(f'<path d="M{path_text}" fill="none" stroke="{colour}" stroke-width="2" clip-path="url(#plot)"/>'
                   f'<text x="{key}" y="{TOP - 8}" text-anchor="end" fill="{colour}">{name}</text>')
        key -= 7 * len(name) + 18
    path.write_text("\n".join(out) + "\n</svg>\n")


def bouncing(runs, folder):
    room = scene([ball("ball", (0, 1.5)), box("floor", (0, -0.5), 20, 1, type="static")], (0, -9.81))
    curves = []
    for integrator in ("explicit_euler", "semi_implicit_euler", "velocity_verlet"):
        rows = runs.by_plumb(room, 6, integrator=integrator)
        curves.append((integrator.replace("_", " "), [(t, row["ball"][1] - 0.5) for t, row in rows]))
    draw(folder / "bounce.svg", "A ball dropped from 1 m, restitution 1, dt = 1/60 s", "t (s)", "height (m)", curves)


def springy(runs, folder):
    spring = {"type": "spring", "body_a": "world", "body_b": "ball", "stiffness": 18, "rest_length": 1}
    swing = scene([ball("ball", (1.2, 0), mass=2)], forces=[spring])
    energy = lambda s: s[3] ** 2 + s[4] ** 2 + 9 * (math.hypot(s[0], s[1]) - 1) ** 2
    curves = []
    for integrator in ("explicit_euler", "semi_implicit_euler", "velocity_verlet"):
        rows = runs.by_plumb(swing, 10, integrator=integrator)
        curves.append((integrator.replace("_", " "), [(t, energy(row["ball"]) / 0.36) for t, row in rows]))
    draw(folder / "spring.svg", "Energy of a ball on a spring, w = 3 rad/s, dt = 1/60 s", "t (s)", "energy / first energy",
         curves)


def masses(runs, folder):
    shot = scene([ball("heavy", (-2, 0), (2, 0), mass=10), ball("light", (0, 0))])
    curves = []
    for name, mistake in (("as it should be", ""), ("inverse mass forgotten", "inverse_mass_forgotten")):
        rows = runs.by_student(shot, 1.5, mistake)
        curves.append((f"heavy, {name}", [(t, row["heavy"][3]) for t, row in rows]))
    curves.append(("light, in both", [(t, row["light"][3]) for t, row in rows]))
    draw(folder / "inverse_mass.svg", "10 kg at 2 m/s hits 1 kg at rest", "t (s)", "vx (m/s)", curves)


def levers(runs, folder):
    rod = scene([ball("ball", (-0.8, 0.8), (2, 0), radius=0.2), box("rod", (0, 0), 0.2, 2, mass=3)])
    curves = []
    for name, mistake in (("as it should be", ""), ("r x n flipped", "r_cross_n_flipped"),
                          ("rotation left out", "no_rotation")):
        rows = runs.by_student(rod, 1, mistake)
        curves.append((name, [(t, row["rod"][2]) for t, row in rows]))
    draw(folder / "flipped.svg", "A ball from the left hits the upper end of a rod", "t (s)", "angle of the rod (rad)", curves)


def sticks(runs, folder):
    stick = {"type": "distance", "name": "stick", "body_a": "a", "body_b": "b", "length": 1}
    pair = scene([ball("a", (-0.5, 0), (0, -1), radius=0.1), ball("b", (0.5, 0), (0, 1), radius=0.1)], joints=[stick])
    length = lambda row: math.hypot(row["b"][0] - row["a"][0], row["b"][1] - row["a"][1])
    curves = []
    for name, mistake in (("as it should be", ""), ("no position correction", "no_position_correction"),
                          ("joint ignored", "joint_ignored")):
        curves.append((name, [(t, length(row)) for t, row in runs.by_student(pair, 5, mistake)]))
    draw(folder / "stick.svg", "Two balls on a stick of 1 m that turns at 2 rad/s", "t (s)", "length (m)", curves, (0.95, 1.35))


def main():
    build = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else HERE / "../../../build/release").resolve()
    folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else HERE)
    runs = Runs(build)
    for figure in (bouncing, springy, masses, levers, sticks):
        figure(runs, folder)
    drawings.write(folder)


main()
