#!/usr/bin/env python3
"""Plants common mistakes in whole_engine.py, rows.py and the course's solved engines, and asks `plumb check`.

usage: common_mistakes.py PLUMB WARM_START STARTERS [--part I/N | NAME...]
  --part I/N   every N-th mistake, from the I-th on
  NAME         only these mistakes; prints what was said

Each was written before anyone looked at which mistakes `plumb check` knows. From its chapter on, the first name must be one
of those that describe it; if there are none, a check fails without a name (UNNAMED), or every check passes (PASSES).
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import more_mistakes
from warm_start import WarmStart

WHOLE, ENGINES = "whole_engine", (more_mistakes.WHOLE, more_mistakes.ROWS)
UNNAMED, PASSES = "unnamed", "passes"

# name, the file and its first chapter, the edits (old text, new text), the names that describe it or what comes of it
MISTAKES = [
    ("gravity counts half", WHOLE, 1,
     [("b.vx += (self.g[0] + b.fx * b.im) * h\n                b.vy += (self.g[1] +",
       "b.vx += (self.g[0] / 2 + b.fx * b.im) * h\n                b.vy += (self.g[1] / 2 +")],
     "gravity_halved gravity_wrong"),
    ("gravity counts half", "chapter1", 1,
     [("body.velocity += self.gravity * self.dt",
       "body.velocity += self.gravity * 0.5 * self.dt")],
     "gravity_halved gravity_wrong"),
    ("angle in degrees", WHOLE, 4,
     [("b.a += b.w * self.dt",
       "b.a += b.w * 57.29577951308232 * self.dt")],
     "degrees"),
    ("angle in degrees", "chapter4", 4,
     [("body.angle += body.spin * self.dt",
       "body.angle += body.spin * 57.29577951308232 * self.dt")],
     "degrees"),
    ("angle taken for degrees in sin and cos", WHOLE, 4,
     [("c, s = cos(self.a), sin(self.a)\n        return c * px",
       "c, s = cos(self.a * 0.017453292519943295), sin(self.a * 0.017453292519943295)\n        return c * px"),
      ("c, s = cos(self.a), sin(self.a)\n        dx, dy",
       "c, s = cos(self.a * 0.017453292519943295), sin(self.a * 0.017453292519943295)\n        dx, dy")],
     "turned_wrong"),
    ("spin times dt twice", WHOLE, 4,
     [("b.a += b.w * self.dt",
       "b.a += b.w * self.dt * self.dt")],
     "turn_wrong"),
    ("spin times dt twice", "chapter4", 4,
     [("body.angle += body.spin * self.dt",
       "body.angle += body.spin * self.dt * self.dt")],
     "turn_wrong"),
    ("two steps for one", WHOLE, 1,
     [("                for _ in range(q[\"every\"]):\n                    world.step()",
       "                for _ in range(2 * q[\"every\"]):\n                    world.step()")],
     "wrong_dt"),
    ("damping of spin", WHOLE, 4,
     [("b.w += b.torque * b.ii * h",
       "b.w = (b.w + b.torque * b.ii * h) * 0.99")],
     "spin_damped"),
    ("damping of spin", "chapter4", 4,
     [("body.spin += body.torque * body.inverse_inertia * self.dt",
       "body.spin = (body.spin + body.torque * body.inverse_inertia * self.dt) * 0.99")],
     "spin_damped"),
    ("restitution always average", WHOLE, 1,
     [("e = rule(self.rules[\"restitution\"], a.e, b.e)",
       "e = (a.e + b.e) / 2")],
     "restitution_average"),
    ("restitution always average", "chapter3", 3,
     [("        contact.bounce = max(0.0, self.restitution(contact.a, contact.b, speed) * speed)",
       "        e = (contact.a.restitution + contact.b.restitution) / 2 if self.restitution(contact.a, contact.b, speed) else 0\n        contact.bounce = max(0.0, e * speed)")],
     "restitution_average"),
    ("restitution of the first body", WHOLE, 1,
     [("e = rule(self.rules[\"restitution\"], a.e, b.e)",
       "e = a.e")],
     "restitution_of_the_first restitution_of_one"),
    ("restitution of the first body", "chapter3", 3,
     [("        contact.bounce = max(0.0, self.restitution(contact.a, contact.b, speed) * speed)",
       "        e = contact.a.restitution if self.restitution(contact.a, contact.b, speed) else 0\n        contact.bounce = max(0.0, e * speed)")],
     "restitution_of_the_first restitution_of_one"),
    ("contacts also pull", WHOLE, 1,
     [("new = max(0.0, c[\"sum\"] + j)",
       "new = c[\"sum\"] + j")],
     "no_test_of_parting"),
    ("contacts also pull", "chapter3", 3,
     [("contact.total = max(0.0, before + j)",
       "contact.total = before + j")],
     "no_test_of_parting"),
    ("correction without masses", WHOLE, 3,
     [("a.shift(-push * nx, -push * ny, rax, ray)\n                b.shift(push * nx, push * ny, rbx, rby)\n        self.n",
       "q = SHARE * max(0.0, depth - SLOP) / (a.dyn + b.dyn)\n                if a.dyn: a.x -= q * nx; a.y -= q * ny\n                if b.dyn: b.x += q * nx; b.y += q * ny\n        self.n")],
     "correction_split_evenly"),
    ("correction without masses", "chapter3", 3,
     [("            a.position -= contact.normal * (push * a.inverse_mass)\n            b.position += contact.normal * (push * b.inverse_mass)",
       "            push = SHARE * max(0.0, contact.depth - SLOP) / (a.moves + b.moves)\n            a.position -= contact.normal * (push * a.moves)\n            b.position += contact.normal * (push * b.moves)")],
     "correction_split_evenly"),
    ("only the second is pushed out", WHOLE, 1,
     [("                a.shift(-push * nx, -push * ny, rax, ray)\n                b.shift(push * nx, push * ny, rbx, rby)\n        self.n",
       "                b.shift(push * nx, push * ny, rbx, rby)\n        self.n")],
     "correction_of_one_only sinks"),
    ("square root forgotten", WHOLE, 3,
     [("            d = hypot(dx, dy)\n            if 0 < d < a.r + b.r:",
       "            d = dx * dx + dy * dy\n            if 0 < d < a.r + b.r:")],
     "square_of_distance"),
    ("square root forgotten", "chapter3", 3,
     [("        distance = way.length()\n        if 0 < distance < reach:",
       "        distance = way.dot(way)\n        if 0 < distance < reach:")],
     "square_of_distance"),
    ("last body left out of pairs", WHOLE, 3,
     [("for b in self.bodies[i + 1:]:",
       "for b in self.bodies[i + 1:-1]:")],
     "pairs_left_out pairs_missed no_detection no_collision"),
    ("last body left out of pairs", "chapter3", 3,
     [("for b in self.bodies[i + 1:]:",
       "for b in self.bodies[i + 1:-1]:")],
     "pairs_left_out pairs_missed no_detection no_collision"),
    ("neighbours in the list only", WHOLE, 3,
     [("for b in self.bodies[i + 1:]:",
       "for b in self.bodies[i + 1:i + 2]:")],
     "pairs_left_out pairs_missed"),
    ("neighbours in the list only", "chapter3", 3,
     [("for b in self.bodies[i + 1:]:",
       "for b in self.bodies[i + 1:i + 2]:")],
     "pairs_left_out pairs_missed"),
    ("inverse masses swapped", "chapter3", 3,
     [("contact.a.velocity -= impulse * contact.a.inverse_mass\n        contact.b.velocity += impulse * contact.b.inverse_mass",
       "contact.a.velocity -= impulse * (contact.b.inverse_mass if contact.b.moves and contact.a.moves else contact.a.inverse_mass)\n        contact.b.velocity += impulse * (contact.a.inverse_mass if contact.a.moves and contact.b.moves else contact.b.inverse_mass)")],
     "masses_swapped"),
    ("whole speed in place of closing speed", WHOLE, 1,
     [("c[\"bounce\"] = -e * vn if",
       "c[\"bounce\"] = e * hypot(vx, vy) if")],
     "bounce_of_whole_speed"),
    ("whole speed in place of closing speed", "chapter3", 3,
     [("        contact.bounce = max(0.0, self.restitution(contact.a, contact.b, speed) * speed)",
       "        contact.bounce = max(0.0, self.restitution(contact.a, contact.b, speed) * (contact.b.velocity - contact.a.velocity).length())")],
     "bounce_of_whole_speed"),
    ("drag with the square", WHOLE, 2,
     [("b.fx -= f[\"coefficient\"] * b.vx\n                b.fy -= f[\"coefficient\"] * b.vy",
       "s = hypot(b.vx, b.vy)\n                b.fx -= f[\"coefficient\"] * b.vx * s\n                b.fy -= f[\"coefficient\"] * b.vy * s")],
     "drag_quadratic"),
    ("drag with the square", "chapter2", 2,
     [("body.force -= body.velocity * law[\"coefficient\"]",
       "body.force -= body.velocity * (law[\"coefficient\"] * body.velocity.length())")],
     "drag_quadratic"),
    ("drag not divided by mass", "chapter2", 2,
     [("body.force -= body.velocity * law[\"coefficient\"]",
       "body.velocity -= body.velocity * (law[\"coefficient\"] * self.dt)")],
     "drag_not_divided"),
    ("direction of a spring not normalised", WHOLE, 2,
     [("dx, dy = dx / length, dy / length\n",
       "pass\n")],
     "spring_not_unit"),
    ("direction of a spring not normalised", "chapter2", 2,
     [("        direction = way * (1 / length)\n        # gap",
       "        direction = way\n        # gap")],
     "spring_not_unit"),
    ("world anchor of a spring ignored", "chapter2", 2,
     [("body.position if body else Vec(*anchor)",
       "body.position if body else Vec(0, 0)")],
     "spring_anchor_ignored"),
    ("spring always pulls", WHOLE, 2,
     [("(length - f[\"rest_length\"])",
       "abs(length - f[\"rest_length\"])")],
     "spring_sign_lost"),
    ("spring always pulls", "chapter2", 2,
     [("(length - law[\"rest_length\"])",
       "abs(length - law[\"rest_length\"])")],
     "spring_sign_lost"),
    ("duration taken for the end", WHOLE, 2,
     [("t >= start + f.get(\"duration\", 1e300) - 1e-12",
       "t >= f.get(\"duration\", 1e300) - 1e-12")],
     "push_missed"),
    ("duration taken for the end", "chapter2", 2,
     [("ends = law[\"start\"] + law.get(\"duration\", float(\"inf\"))",
       "ends = law.get(\"duration\", float(\"inf\"))")],
     "push_missed"),
    ("time counted in steps", WHOLE, 2,
     [("t, h = self.n * self.dt, self.dt",
       "t, h = self.n, self.dt")],
     "push_missed"),
    ("damping from one end", WHOLE, 2,
     [("rate = (bvx - avx) * dx + (bvy - avy) * dy\n                force",
       "rate = bvx * dx + bvy * dy\n                force")],
     "damping_of_one_end"),
    ("damping from one end", "chapter2", 2,
     [("(v_b - v_a).dot(direction)",
       "v_b.dot(direction)")],
     "damping_of_one_end"),
    ("integer division of the mass", WHOLE, 1,
     [("self.im = 1 / b[\"mass\"] if",
       "self.im = 1 // b[\"mass\"] if")],
     "integer_division"),
    ("integer division of the mass", "chapter2", 2,
     [("1 / scene[\"mass\"] if",
       "1 // scene[\"mass\"] if")],
     "integer_division"),
    ("torque by the dot product", WHOLE, 4,
     [("b.torque += cross(rx, ry, fx, fy)",
       "b.torque += rx * fx + ry * fy")],
     "dot_for_cross"),
    ("torque by the dot product", "chapter4", 4,
     [("body.torque += arm.cross(force)",
       "body.torque += arm.dot(force)")],
     "dot_for_cross"),
    ("arm not turned", WHOLE, 4,
     [("rx, ry = b.point(*f[\"point\"])",
       "rx, ry = f[\"point\"]")],
     "point_not_turned"),
    ("arm not turned", "chapter4", 4,
     [("arm = Vec(*point).turned(body.angle)",
       "arm = Vec(*point)")],
     "point_not_turned"),
    ("arms from the origin", WHOLE, 4,
     [("rax, ray, rbx, rby = px - a.x, py - a.y, px - b.x, py - b.y\n                c = ",
       "rax, ray, rbx, rby = px, py, px, py\n                c = ")],
     "lever_from_origin wrong_arm"),
    ("velocity of a point turned the wrong way", WHOLE, 4,
     [("return self.vx - self.w * ry, self.vy + self.w * rx",
       "return self.vx + self.w * ry, self.vy - self.w * rx")],
     "point_velocity point_velocity_wrong wrong_spin"),
    ("velocity of a point turned the wrong way", "chapter4", 4,
     [("Vec(-self.spin * r.y, self.spin * r.x)",
       "Vec(self.spin * r.y, -self.spin * r.x)")],
     "point_velocity"),
    ("rotation left out of friction", "chapter4", 4,
     [("sliding = self.velocity_apart(contact).dot(tangent)",
       "sliding = (contact.b.velocity - contact.a.velocity).dot(tangent)")],
     "point_velocity wrong_arm wrong_spin"),
    ("rotation left out of friction", WHOLE, 4,
     [("        vx, vy = self.relative(c)\n        j = -(vx * tx",
       "        vx, vy = c[\"b\"].vx - c[\"a\"].vx, c[\"b\"].vy - c[\"a\"].vy\n        j = -(vx * tx")],
     "point_velocity wrong_arm wrong_spin"),
    ("spin by the inverse mass", WHOLE, 4,
     [("self.w += cross(rx, ry, jx, jy) * self.ii",
       "self.w += cross(rx, ry, jx, jy) * (self.im if self.ii else 0)")],
     "inertia_forgotten wrong_inertia"),
    ("spin by the inverse mass", "chapter4", 4,
     [("* a.inverse_inertia\n        b.spin += (contact.point - b.position).cross(impulse) * b.inverse_inertia",
       "* (a.inverse_mass if a.inverse_inertia else 0)\n        b.spin += (contact.point - b.position).cross(impulse) * (b.inverse_mass if b.inverse_inertia else 0)")],
     "inertia_forgotten wrong_inertia"),
    ("only the second body turns", "chapter4", 4,
     [("        a.spin -= (contact.point - a.position).cross(impulse) * a.inverse_inertia\n",
       "")],
     "one_body_never_spins wrong_arm wrong_inertia"),
    ("only the axes of the first box", WHOLE, 4,
     [("for box in (a, b):\n            for lx",
       "for box in (a,):\n            for lx")],
     "axes_left_out"),
    ("only the axes of the first box", "chapter4", 4,
     [("        for box in (a, b):\n            for axis",
       "        for box in (a,):\n            for axis")],
     "axes_left_out"),
    ("largest overlap", WHOLE, 4,
     [("overlap < best[0] - 1e-9",
       "overlap > best[0] + 1e-9")],
     "largest_overlap"),
    ("largest overlap", "chapter4", 4,
     [("overlap < least - 1e-9",
       "overlap > least + 1e-9")],
     "largest_overlap"),
    ("no absolute value in the extent", WHOLE, 4,
     [("return box.hw * abs(nx * xx + ny * xy) + box.hh * abs(nx * yx + ny * yy)",
       "return abs(box.hw * (nx * xx + ny * xy) + box.hh * (nx * yx + ny * yy))")],
     "extent_wrong"),
    ("face clipped at half its width", WHOLE, 4,
     [("s = min(max(s, -half), half)",
       "s = min(max(s, -half / 2), half / 2)")],
     "clipped_wrong"),
    ("face clipped at half its width", "chapter4", 4,
     [("half = self.extent(face_of, along)\n",
       "half = self.extent(face_of, along) / 2\n")],
     "clipped_wrong"),
    ("one contact point, the deepest", WHOLE, 4,
     [("        return points\n",
       "        return sorted(points, key=lambda p: p[2])[-1:]\n")],
     "one_corner"),
    ("one contact point, the deepest", "chapter4", 4,
     [("                contacts.append(Contact(a, b, normal, depth, point))\n        return contacts",
       "                contacts.append(Contact(a, b, normal, depth, point))\n        return sorted(contacts, key=lambda c: c.depth)[-1:]")],
     "one_corner"),
    ("corners farthest out", WHOLE, 4,
     [("p1x, p1y), (p2x, p2y) = corners[:2]",
       "p1x, p1y), (p2x, p2y) = corners[2:]")],
     "corners_farthest_out"),
    ("friction with the restitution", WHOLE, 4,
     [("c[\"mu\"] = rule(self.rules[\"friction\"], a.mu, b.mu)",
       "c[\"mu\"] = rule(self.rules[\"friction\"], a.e, b.e)")],
     "friction_by_restitution"),
    ("friction with the restitution", "chapter4", 4,
     [("COMBINE[self.rules[\"friction\"]](contact.a.friction, contact.b.friction)",
       "COMBINE[self.rules[\"friction\"]](contact.a.restitution, contact.b.restitution)")],
     "friction_by_restitution"),
    ("friction bounded on one side", WHOLE, 4,
     [("new = min(max(c[\"rub\"] + j, -most), most)",
       "new = min(c[\"rub\"] + j, most)")],
     "friction_limited_on_one_side"),
    ("friction bounded on one side", "chapter4", 4,
     [("min(max(before + j, -most), most)",
       "min(before + j, most)")],
     "friction_limited_on_one_side"),
    ("friction with the mass of the normal", WHOLE, 4,
     [("/ c[\"kt\"]",
       "/ c[\"k\"]")],
     "friction_mass_of_normal"),
    ("friction with the mass of the normal", "chapter4", 4,
     [("self.inverse_effective_mass(contact, tangent)",
       "self.inverse_effective_mass(contact, contact.normal)")],
     "friction_mass_of_normal"),
    ("sign lost in the tangent", WHOLE, 4,
     [("tx, ty = -ny, nx\n        vx, vy",
       "tx, ty = ny, nx\n        vx, vy")],
     "axis_reversed"),
    ("sign lost in the tangent", "chapter4", 4,
     [("tangent = Vec(-contact.normal.y, contact.normal.x)",
       "tangent = Vec(contact.normal.y, contact.normal.x)")],
     "axis_reversed"),
    ("bound of friction from the last impulse", WHOLE, 4,
     [("        j, c[\"sum\"] = new - c[\"sum\"], new\n        self.apply(c, j * nx, j * ny)\n        tx",
       "        j, c[\"sum\"] = new - c[\"sum\"], new\n        last = j\n        self.apply(c, j * nx, j * ny)\n        tx"),
      ("most = c[\"mu\"] * c[\"sum\"]",
       "most = c[\"mu\"] * abs(last)")],
     "friction_by_last_impulse"),
    ("anchors not turned", WHOLE, 5,
     [("return self.body.point(self.px, self.py)",
       "return self.px, self.py")],
     "anchor_not_turned"),
    ("anchors not turned", "chapter5", 5,
     [("return self.anchor_a.turned(self.a.angle), self.anchor_b.turned(self.b.angle)",
       "return self.anchor_a, self.anchor_b")],
     "anchor_not_turned"),
    ("anchor of a for both", "chapter5", 5,
     [("Vec(*scene[\"anchor_a\"]), Vec(*scene[\"anchor_b\"])",
       "Vec(*scene[\"anchor_a\"]), Vec(*scene[\"anchor_a\"])")],
     "one_anchor"),
    ("arm of b left out of the joint's mass", "chapter5", 5,
     [("arm_a.cross(n) ** 2 * a.inverse_inertia +\n                arm_b.cross(n) ** 2 * b.inverse_inertia)",
       "arm_a.cross(n) ** 2 * a.inverse_inertia)")],
     UNNAMED),
    ("length of a stick ignored", WHOLE, 5,
     [("error = d if length is None else d - length",
       "error = d")],
     "length_ignored"),
    ("joined bodies collide", WHOLE, 5,
     [("and (id(a), id(b)) not in self.joined",
       "")],
     "joined_bodies_collide"),
    ("stale speed for the second axis", "chapter5", 5,
     [("            speed = (b.velocity_at(b.position + arm_b) - a.velocity_at(a.position + arm_a)).dot(n)\n",
       "            speed = rates[n.x == 1 and n.y == 0 or len(rates) == 1].dot(n) if False else old.dot(n)\n"),
      ("        arm_a, arm_b = self.arms()\n        for n in self.directions():",
       "        arm_a, arm_b = self.arms()\n        old = b.velocity_at(b.position + arm_b) - a.velocity_at(a.position + arm_a)\n        for n in self.directions():")],
     PASSES),
    ("joints do not turn bodies", "chapter5", 5,
     [("            a.spin -= arm_a.cross(impulse) * a.inverse_inertia\n            b.spin += arm_b.cross(impulse) * b.inverse_inertia\n",
       "")],
     "joint_never_spins wrong_arm wrong_inertia"),
    ("last joint skipped", WHOLE, 5,
     [("            for joint in self.joints:\n                self.solve_joint(joint)",
       "            for joint in self.joints[:-1]:\n                self.solve_joint(joint)"),
      ("            for joint in self.joints:\n                self.fix_joint(joint)",
       "            for joint in self.joints[:-1]:\n                self.fix_joint(joint)")],
     "joints_left_out joint_ignored"),
    ("last joint skipped", "chapter5", 5,
     [("            for joint in self.joints:\n                joint.solve()",
       "            for joint in self.joints[:-1]:\n                joint.solve()"),
      ("            for joint in self.joints:\n                joint.correct()",
       "            for joint in self.joints[:-1]:\n                joint.correct()")],
     "joints_left_out joint_ignored"),
    ("impulse over the sum of masses", WHOLE, 3,
     [("j = (c[\"bounce\"] - (vx * nx + vy * ny)) / c[\"k\"]",
       "j = (c[\"bounce\"] - (vx * nx + vy * ny)) / 2 / c[\"k\"]")],
     PASSES),
    ("contact impulse at half", "chapter3", 3,
     [("contact.total = max(0.0, before + j)",
       "contact.total = max(0.0, before + j / 2)"),
      ("SWEEPS = 30",
       "SWEEPS = 1")],
     "impulse_halved impulse_wrong"),
    ("joint corrected the wrong way", WHOLE, 5,
     [("push = SHARE * error / inverse_mass",
       "push = -SHARE * error / inverse_mass")],
     "correction_backwards"),
    ("joint corrected the wrong way", "chapter5", 5,
     [("push = n * (-SHARE * size",
       "push = n * (SHARE * size")],
     "correction_backwards"),
]


def planted(folder, starters, mistake):
    """Writes the engine with the mistake and returns the program of a chapter."""
    name, file, _, edits, _ = mistake
    if file in ENGINES:
        text = pathlib.Path(__file__).with_name(f"{file}.py").read_text(encoding="utf-8")
    else:
        shutil.copytree(starters / "python", folder / "python")
        text = (starters / "python" / "solved" / f"{file}.py").read_text(encoding="utf-8")
    for old, new in edits:
        if text.count(old) != 1:
            sys.exit(f"{name}: its text is there {text.count(old)} times")
        text = text.replace(old, new)
    solved = folder / "python" / "solved"
    place = folder / "engine.py" if file in ENGINES else solved / f"{file}.py"
    place.write_text(text, encoding="utf-8")
    return lambda chapter: place if file in ENGINES else solved / f"chapter{chapter}.py"


def outcome(plumb, warm, starters, mistake):
    """The first name, or UNNAMED or PASSES, and what was said."""
    told = PASSES, ""
    accepted = mistake[4].split()
    with tempfile.TemporaryDirectory() as folder:
        program = planted(pathlib.Path(folder), starters, mistake)
        for chapter in range(mistake[2], 6):
            run = subprocess.run([plumb, "check", "--chapter", str(chapter), "--format", "json", "--",
                                  *warm.command(program(chapter))], capture_output=True, text=True, check=False)
            for result in json.loads(run.stdout)["results"]:
                if result["verdict"] not in ("fail", "broken"):
                    continue
                if result["mistake"]:
                    return result["mistake"], result["says"]
                # Accepts both descriptions: two mistakes give the same motion, so check names neither.
                both = [name for name in accepted if f" {name}: " in result["says"]]
                if both:
                    return both[0], result["says"]
                told = UNNAMED, result["says"]
    return told


def main():
    plumb, client, starters, chosen = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]), sys.argv[4:]
    mistakes = MISTAKES + more_mistakes.MISTAKES
    if chosen[:1] == ["--part"]:
        first, parts = map(int, chosen[1].split("/"))
        mistakes, chosen = mistakes[first - 1 :: parts], []
    counts, failures = {"named": 0, UNNAMED: 0, PASSES: 0}, 0
    with WarmStart(client) as warm:
        for mistake in mistakes:
            if chosen and mistake[0] not in chosen:
                continue
            found, says = outcome(plumb, warm, starters, mistake)
            counts[found if found in counts else "named"] += 1
            if chosen:
                print(f"{mistake[0]} ({mistake[1]}): {found}: {says}")
            if found not in mistake[4].split():
                failures += 1
                print(f"{mistake[0]} ({mistake[1]}): '{found}', not '{mistake[4]}': {says}")
    print(f"{len(mistakes)} mistakes: {counts}, {failures} not as expected")
    sys.exit(failures > 0)


if __name__ == "__main__":
    main()
