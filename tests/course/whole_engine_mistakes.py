#!/usr/bin/env python3
"""Plants mistakes in whole_engine.py and asks `plumb check` for their names.

usage: whole_engine_mistakes.py PLUMB [NAME...]    NAME: only these mistakes; prints what was said

Each mistake is a text that is replaced. From its chapter on, the first check that fails must name it.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

# name, first chapter that shows it, old text, new text, the name that describes it
MISTAKES = [
    ('walls of twice the size', 1,
     'self.hw, self.hh = s["width"] / 2, s["height"] / 2',
     'self.hw, self.hh = s["width"], s["height"]',
     "whole_sizes"),
    ('e on the tangent too', 1,
     '        self.apply(c, j * nx, j * ny)\n        tx',
     "        self.apply(c, j * nx, j * ny)\n        if j > 0 and c['bounce'] > 0 and not c.get('q'):\n            c['q'] = 1\n            for o in (c['a'], c['b']):\n                if o.dyn:\n                    if abs(ny) > abs(nx): o.vx *= 0.8\n                    else: o.vy *= 0.8\n        tx",
     "along_wall_changed"),
    ('dt of 1/60 always', 1,
     'self.dt, self.n = dt, 0',
     'self.dt, self.n, self.dt0 = 1 / 60, 0, dt',
     "wrong_dt"),
    ('half of g h^2 more', 1,
     '                b.y += b.vy * self.dt',
     '                b.y += b.vy * self.dt + self.g[1] * self.dt ** 2 / 2',
     "half_a_step_twice"),
    ('speed clamped at 5', 1,
     '                b.x += b.vx * self.dt',
     '                f = hypot(b.vx, b.vy)\n                if f > 5: b.vx *= 5 / f; b.vy *= 5 / f\n                b.x += b.vx * self.dt',
     "speed_limited"),
    ('positions rounded to 1 cm', 1,
     '                b.a += b.w * self.dt',
     '                b.a += b.w * self.dt\n                b.x, b.y = round(b.x, 2), round(b.y, 2)',
     "state_rounded"),
    ('no bounce below 3 m/s', 1,
     'slow = max(2 *',
     'slow = max(3, 2 *',
     "threshold_too_high"),
    ('air slows x', 1,
     '                b.vx += (self.g[0]',
     '                b.vx *= 1 - 0.1 * h\n                b.vx += (self.g[0]',
     "damping"),
    ('gravity x into y', 1,
     'b.vy += (self.g[1] +',
     'b.vy += (self.g[1] + self.g[0] +',
     "gravity_mixed"),
    ('drag times mass', 2,
     'b.fx -= f["coefficient"] * b.vx',
     'b.fx -= f["coefficient"] * b.vx / b.im',
     "drag_not_divided"),
    ('duration counted from 0', 2,
     't >= start + f.get(',
     't >= f.get(',
     "push_missed"),
    ('stiffness halved', 2,
     'force = f["stiffness"]',
     'force = 0.5 * f["stiffness"]',
     "stiffness_wrong"),
    ('spring as rope', 2,
     'self.push(a, force * dx',
     'force = max(force, 0)\n                self.push(a, force * dx',
     "spring_only_pulls"),
    ('force to body 0', 2,
     '                b = self.names[f["body"]]\n                rx, ry',
     '                b = self.bodies[-1]\n                rx, ry',
     "force_on_wrong_body"),
    ('force in kilograms', 2,
     '        b.fx += fx\n        b.fy += fy',
     '        b.fx += 9.81 * fx\n        b.fy += 9.81 * fy',
     "force_in_kilograms"),
    ('effective mass of a twice', 3,
     '    return (a.im + b.im + cross',
     '    return (2 * (a.im or b.im) + cross',
     "masses_wrong"),
    ('bounce anew each sweep', 3,
     '        j = (c["bounce"] - (vx * nx + vy * ny)) / c["k"]',
     "        vn = vx * nx + vy * ny\n        j = ((-vn if vn < 0 and c['bounce'] else 0) - vn) / c['k'] ",
     "restitution_ignored"),
    ('neighbours only', 3,
     'for b in self.bodies[i + 1:]:\n                if (a',
     'for b in self.bodies[i + 1:i + 2]:\n                if (a',
     "pairs_missed"),
    ('correction shares swapped', 3,
     '                a.shift(-push * nx, -push * ny, rax, ray)\n                b.shift(push * nx, push * ny, rbx, rby)',
     '                if a.dyn and b.dyn and a.r and b.r:\n                    k = push * (a.im + b.im)\n                    fa, fb = b.im / (a.im + b.im), a.im / (a.im + b.im)\n                    a.x -= k * fa * nx; a.y -= k * fa * ny; b.x += k * fb * nx; b.y += k * fb * ny\n                    continue\n                a.shift(-push * nx, -push * ny, rax, ray)\n                b.shift(push * nx, push * ny, rbx, rby)',
     "correction_shares_swapped"),
    ('inertia of (w + h)^2', 4,
     '(s["width"] ** 2 + s["height"] ** 2)',
     '(s["width"] + s["height"]) ** 2',
     "square_of_sum"),
    ('angle backwards', 4,
     '                b.a += b.w * self.dt',
     '                b.a -= b.w * self.dt',
     "turns_backwards"),
    ('point velocity flipped', 4,
     'return self.vx - self.w * ry, self.vy + self.w * rx',
     'return self.vx + self.w * ry, self.vy - self.w * rx',
     "point_velocity"),
    ('friction limited by the last impulse', 4,
     'most = c["mu"] * c["sum"]',
     'most = c["mu"] * abs(j)',
     "friction_as_damping"),
    ('sum of both mu', 4,
     'c["mu"] = rule(self.rules["friction"], a.mu, b.mu)',
     'c["mu"] = a.mu + b.mu',
     "friction_sum"),
    ('no clipping at the ends', 4,
     '            s = min(max(s, -half), half)\n',
     '',
     "not_clipped"),
    ('fixed_rotation ignored', 4,
     'if self.dyn and not b["fixed_rotation"]',
     'if self.dyn',
     "fixed_rotation_ignored"),
    ('torque without dt', 4,
     'b.w += b.torque * b.ii * h',
     'b.w += b.torque * b.ii',
     "torque_without_dt"),
    ('friction as damping', 4,
     '        tx, ty = -ny, nx\n        vx, vy = self.relative(c)\n',
     "        if not c.get('q') and c['mu'] and c['sum']:\n            c['q'] = 1\n            for o in (c['a'], c['b']):\n                o.vx *= 1 - c['mu'] * self.dt\n        return\n        tx, ty = -ny, nx\n        vx, vy = self.relative(c)\n",
     "friction_as_damping"),
    ('hinge along x only', 5,
     'axes = ((1.0, 0.0), (0.0, 1.0))',
     'axes = ((1.0, 0.0),)',
     "hinge_one_axis"),
    ('anchor of the world ignored', 5,
     'Point(a, *j["anchor_a"])',
     'Point(a, *(j["anchor_a"] if a is not WORLD else (1.0, 0.0)))',
     "joint_ignored"),
    ('joined bodies collide', 5,
     'if not j["collide"]:',
     'if False:',
     "joined_bodies_collide"),
    ('joint mass 1/(ma + mb)', 5,
     '            j = -rate / inverse_mass(a, b, rax, ray, rbx, rby, nx, ny)\n            a.impulse',
     '            j = -rate / ((1 / a.im if a.im else 0) + (1 / b.im if b.im else 0))\n            a.impulse',
     "joint_impulse_weak"),
]


def first_named(plumb, program, chapter):
    """The name that the first failing check gives, from `chapter` on, and what it says."""
    for number in range(chapter, 6):
        run = subprocess.run([plumb, "check", "--chapter", str(number), "--format", "json", "--", sys.executable, program],
                             capture_output=True, text=True, check=False)
        for result in json.loads(run.stdout)["results"]:
            if result["verdict"] in ("fail", "broken"):
                return result["mistake"], result["says"]
    return "", "all checks pass"


def main():
    plumb, chosen = sys.argv[1], sys.argv[2:]
    engine = pathlib.Path(__file__).with_name("whole_engine.py").read_text(encoding="utf-8")
    failures = 0
    if not chosen:
        with_none = first_named(plumb, str(pathlib.Path(__file__).with_name("whole_engine.py")), 1)
        if with_none[0] or with_none[1] != "all checks pass":
            print(f"the engine without mistakes: {with_none}")
            failures += 1
    with tempfile.TemporaryDirectory() as folder:
        for name, chapter, old, new, expected in MISTAKES:
            if chosen and name not in chosen:
                continue
            if engine.count(old) != 1:
                sys.exit(f"{name}: its text is there {engine.count(old)} times")
            program = pathlib.Path(folder) / "engine.py"
            program.write_text(engine.replace(old, new), encoding="utf-8")
            found, says = first_named(plumb, str(program), chapter)
            if chosen:
                print(f"{name}: {found}: {says}")
            if found != expected:
                failures += 1
                print(f"{name}: is called '{found}', not '{expected}': {says}")
    print(f"{len(MISTAKES)} mistakes, {failures} failures")
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
