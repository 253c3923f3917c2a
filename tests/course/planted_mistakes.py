#!/usr/bin/env python3
"""Plants mistakes in the course's solved engines in Python and asks `plumb check` for their names.

usage: planted_mistakes.py PLUMB WARM_START STARTERS [--part N/M | NAME...]
    --part: every Mth mistake, from the Nth on; NAME: only these mistakes; prints what was said

Each mistake is a text that is replaced in solved/chapterN.py. The first mistake that `plumb check` names, over the chapters
up to that one, must be one of those that describe it. ONE_SWEEP marks mistakes that iteration repairs in part, as an engine
makes them that goes over its contacts once a step.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

from warm_start import WarmStart

CLOCK = """        import time
        now = time.perf_counter()
        self.dt, self.last = now - getattr(self, "last", now - 1 / 60), now
        self.accelerate()
        self.move()
        for ball"""
ONE_SWEEP = ("chapter3", "SWEEPS = 30", "SWEEPS = 1")
PLAIN_CONTACT = """        j = (contact.bounce - self.closing(contact)) / self.inverse_effective_mass(contact, contact.normal)
        before = contact.total
        contact.total = max(0.0, before + j)
        self.apply_impulse(contact, contact.normal * (contact.total - before))"""

# name, chapter, old text, new text, names that describe it, further edits
MISTAKES = [
    ("wall clock as dt", 1, "        self.accelerate()\n        self.move()\n        for ball", CLOCK, {"wrong_dt"}),
    ("wall clock for the velocity", 1, "self.gravity * self.dt\n",
     "self.gravity * (self.dt + 1e-9 * (__import__('time').perf_counter_ns() % 100000))\n", {"runs_differ"}),
    ("damping a frame", 1, "body.velocity += self.gravity * self.dt", "body.velocity = (body.velocity + self.gravity * self.dt) * 0.99",
     {"damping"}),
    ("9.8 for 9.81", 1, 'Vec(*scene["gravity"])', "Vec(0, -9.8)", {"gravity_hard_coded"}),
    ("gravity of a constant 9.81", 1, 'Vec(*scene["gravity"])', "Vec(0, -9.81)", {"gravity_hard_coded"}),
    ("y down", 1, "body.velocity += self.gravity", "body.velocity -= self.gravity", {"gravity_upwards"}),
    ("explicit Euler", 1, "        self.accelerate()\n        self.move()", "        self.move()\n        self.accelerate()",
     {"explicit_euler"}),
    ("no dt for the velocity", 1, "self.gravity * self.dt\n", "self.gravity\n", {"dt_missing"}),
    ("no dt for the position", 1, "body.velocity * self.dt", "body.velocity", {"velocity_without_dt"}),
    ("dt in milliseconds", 1, "self.dt, self.steps = dt, 0", "self.dt, self.steps = dt * 1000, 0", {"wrong_dt", "milliseconds"}),
    ("normal of a wall flipped", 1, "normal = way * (1 / distance)", "normal = way * (-1 / distance)", {"normal_flipped"}),
    ("normal of a wall not normalised", 1, "normal = way * (1 / distance)", "normal = way", {"normal_not_unit"}),
    ("restitution squared", 1, '(a.restitution, b.restitution)', '(a.restitution, b.restitution) ** 2', {"restitution_squared"}),
    ("e for 1 + e", 1, "(1 + self.restitution", "(self.restitution", {"one_plus_forgotten"}),
    ("whole velocity reversed", 1, "ball.velocity -= normal * ((1 + self.restitution(ball, wall, -closing)) * closing)",
     "ball.velocity = -ball.velocity", {"both_turned"}),
    ("no position correction at walls, velocity reversed each step", 1,
     "        ball.position += normal * (ball.radius - distance)\n        closing = ball.velocity.dot(normal)\n        if closing < 0:",
     "        closing = ball.velocity.dot(normal)\n        if True:", {"turned_every_step"}),
    ("static bodies fall", 1, "            if body.moves:\n                # gap: add gravity", "            if True:\n                # gap: add gravity",
     {"static_moves"}),
    ("force not divided by mass", 2, "body.force * body.inverse_mass", "body.force", {"mass_not_divided"}),
    ("forces not cleared", 2, "            body.force = Vec(0, 0)\n        # end", "            pass\n        # end", {"force_not_cleared"}),
    ("gravity divided by mass", 2, "(self.gravity + body.force * body.inverse_mass)", "((self.gravity + body.force) * body.inverse_mass)",
     {"gravity_divided_by_mass"}),
    ("last force only", 2, "    def push(self, body, force, point):\n        body.force += force",
     "    def push(self, body, force, point):\n        body.force = force", {"last_force_only"}),
    ("drag with the velocity", 2, "body.force -= body.velocity", "body.force += body.velocity", {"drag_pushes"}),
    ("rest length ignored", 2, '(length - law["rest_length"])', "length", {"rest_length_ignored"}),
    ("push never ends", 2, "<= time < ends - 1e-9", "<= time", {"push_never_ends"}),
    ("normal of circles flipped", 3, "            normal = way * (1 / distance)\n            return", "            normal = way * (-1 / distance)\n            return",
     {"normal_flipped"}),
    ("normal of circles not normalised", 3, "            normal = way * (1 / distance)\n            return", "            normal = way\n            return",
     {"normal_not_unit"}),
    ("normal of circles not normalised, one sweep", 3, "            normal = way * (1 / distance)\n            return",
     "            normal = way\n            return", {"normal_not_unit"}, ONE_SWEEP),
    ("static bodies take velocity", 3, "contact.a.velocity -= impulse * contact.a.inverse_mass\n        contact.b.velocity += impulse * contact.b.inverse_mass",
     "contact.a.velocity -= impulse * (contact.a.inverse_mass or 1)\n        contact.b.velocity += impulse * (contact.b.inverse_mass or 1)",
     {"static_has_mass", "static_moves"}),
    ("static bodies have mass", 2, "1 / scene[\"mass\"] if self.moves else 0", "1 / (scene[\"mass\"] or 1)", {"static_has_mass", "static_moves"}),
    ("no test of moving apart, one sweep", 3, PLAIN_CONTACT,
     "        e = self.restitution(contact.a, contact.b, abs(self.closing(contact)))\n"
     "        self.apply_impulse(contact, contact.normal * (-(1 + e) * self.closing(contact) / "
     "self.inverse_effective_mass(contact, contact.normal)))", {"no_test_of_parting"}, ONE_SWEEP),
    ("sum of impulses may be negative", 3, "max(0.0, before + j)", "before + j", {"no_test_of_parting"}),
    ("position correction split evenly", 3,
     "a.position -= contact.normal * (push * a.inverse_mass)\n            b.position += contact.normal * (push * b.inverse_mass)",
     "push = SHARE * max(0.0, contact.depth - SLOP) / 2\n            a.position -= contact.normal * (push * a.moves)\n"
     "            b.position += contact.normal * (push * b.moves)", {"correction_split_evenly"}),
    ("position correction of the wrong sign", 3,
     "a.position -= contact.normal * (push * a.inverse_mass)\n            b.position += contact.normal * (push * b.inverse_mass)",
     "a.position += contact.normal * (push * a.inverse_mass)\n            b.position -= contact.normal * (push * b.inverse_mass)",
     {"pushed_together", "normal_flipped", "overlaps_stay"}),
    ("masses for inverse masses, one sweep", 3, "return contact.a.inverse_mass + contact.b.inverse_mass",
     "return sum(1 / b.inverse_mass for b in (contact.a, contact.b) if b.inverse_mass)", {"masses_in_place_of_inverses"}, ONE_SWEEP),
    ("correction by velocity", 3, "contact.bounce = max(0.0, self.restitution(contact.a, contact.b, speed) * speed)",
     "contact.bounce = max(0.0, self.restitution(contact.a, contact.b, speed) * speed) + 0.2 * contact.depth / self.dt",
     {"correction_adds_energy"}),
    ("diameters for radii", 3, "reach = a.radius + b.radius", "reach = 2 * (a.radius + b.radius)", {"diameters"}),
    ("degrees for radians", 4, "body.angle += body.spin * self.dt", "body.angle += __import__('math').degrees(body.spin * self.dt)", {"degrees"}),
    ("torque backwards", 4, "body.torque += arm.cross(force)", "body.torque -= arm.cross(force)", {"torque_backwards"}),
    ("inertia of a box 1/6", 4, "4 * self.half.y ** 2) / 12", "4 * self.half.y ** 2) / 6", {"inertia_sixth"}),
    ("inertia of a box w h", 4, "mass * (4 * self.half.x ** 2 + 4 * self.half.y ** 2) / 12", "mass * (4 * self.half.x * self.half.y) / 12",
     {"inertia_half", "box_by_area"}),
    ("inertia of a box from half sides", 4, "(4 * self.half.x ** 2 + 4 * self.half.y ** 2) / 12", "(self.half.x ** 2 + self.half.y ** 2) / 12",
     {"half_sides"}),
    ("inertia of a disc as of a ring", 4, "self.radius ** 2 / 2", "self.radius ** 2", {"disc_as_ring"}),
    ("angle wrapped", 4, "body.angle += body.spin * self.dt",
     "body.angle += body.spin * self.dt\n                body.angle = __import__('math').remainder(body.angle, 6.283185307179586)", {"wrapped"}),
    ("point not turned", 4, "arm = Vec(*point).turned(body.angle)", "arm = Vec(*point)", {"point_not_turned"}),
    ("arm from the origin", 4, "        r = point - self.position", "        r = point", {"lever_from_origin"}),
    ("r x n flipped", 4, "a.spin -= (contact.point - a.position).cross(impulse) * a.inverse_inertia\n        b.spin += (contact.point - b.position)",
     "a.spin += (contact.point - a.position).cross(impulse) * a.inverse_inertia\n        b.spin -= (contact.point - b.position)",
     {"r_cross_n_flipped"}),
    ("effective mass without rotation, one sweep", 4,
     "return a.inverse_mass + b.inverse_mass + arm_a ** 2 * a.inverse_inertia + arm_b ** 2 * b.inverse_inertia",
     "return a.inverse_mass + b.inverse_mass", {"effective_mass_without_rotation"}, ONE_SWEEP),
    ("one contact of two", 4, "        for point in ends:", "        for point in ends[:1]:", {"one_corner"}),
    ("friction backwards", 4, "j = -sliding /", "j = sliding /", {"friction_backwards"}),
    ("friction without a limit", 4, "before, most = contact.total_across, contact.friction * contact.total", "before, most = contact.total_across, 1e9",
     {"friction_unlimited"}),
    ("friction averaged", 4, 'COMBINE[self.rules["friction"]]', 'COMBINE["average"]', {"friction_average"}),
    ("axis of largest overlap", 4, "overlap < least - 1e-9", "overlap > least + 1e-9", {"largest_overlap"}),
    ("stick moves both ends alike", 5, "            a.velocity -= impulse * a.inverse_mass\n            b.velocity += impulse * b.inverse_mass",
     "            a.velocity -= n * (-speed / 2 * (a.inverse_mass > 0))\n            b.velocity += n * (-speed / 2 * (b.inverse_mass > 0))",
     {"masses_ignored"}),
    ("stick holds one end only", 5, "            a.velocity -= impulse * a.inverse_mass\n            b.velocity", "            b.velocity",
     {"one_body_only", "momentum_not_kept", "spin_lost"}),
    ("impulse of a stick backwards", 5, "impulse = n * (-speed /", "impulse = n * (speed /", {"impulse_backwards"}),
    ("no position correction of joints", 5, "SHARE * size /", "0 * size /", {"no_position_correction"}),
    ("anchors not turned", 5, "return self.anchor_a.turned(self.a.angle), self.anchor_b.turned(self.b.angle)", "return self.anchor_a, self.anchor_b",
     {"anchor_not_turned"}),
    ("closing test of walls reversed", 1, "if closing < 0:", "if closing > 0:", {"closing_test_reversed"}),
    ("closing test of circles reversed", 3, "max(0.0, before + j)", "min(0.0, before + j)", {"closing_test_reversed"}),
    ("normal from a wall's centre", 1, "normal = way * (1 / distance)",
     "way = ball.position - wall.position\n        normal = way * (1 / way.length())", {"normal_from_centre"}),
    ("drag moves the ball", 2, "body.force -= body.velocity * law[\"coefficient\"]",
     "body.position -= body.velocity * (law[\"coefficient\"] * self.dt)", {"force_moves_position"}),
    ("corner of a box twice", 4, "self.position + w - h, self.position + w + h", "self.position + w - h, self.position + w - h",
     {"corner_missing"}),
    ("anchors turned backwards", 5, "return self.anchor_a.turned(self.a.angle), self.anchor_b.turned(self.b.angle)",
     "return self.anchor_a.turned(-self.a.angle), self.anchor_b.turned(-self.b.angle)", {"turned_backwards"}),
    ("direction of a stick not normalised", 5, "return [way * (1 / way.length())]", "return [way]", {"normal_not_unit"}),
    ("spin left out of a joint's speed", 5, "speed = (b.velocity_at(b.position + arm_b) - a.velocity_at(a.position + arm_a)).dot(n)",
     "speed = (b.velocity - a.velocity).dot(n)", {"point_velocity"}),
    ("one iteration", 5, "in range(SWEEPS)", "in range(1)", {"too_few_iterations"}, ("chapter5", "CORRECTIONS = 8", "CORRECTIONS = 1")),
]


def plant(folder, chapter, old, new):
    path = folder / "solved" / f"{chapter}.py"
    text = path.read_text()
    if text.count(old) != 1:
        sys.exit(f"{chapter}.py has {old!r} {text.count(old)} times")
    path.write_text(text.replace(old, new))


def first_named(plumb, warm, starters, mistake):
    """(what was named first, where, what it said), or None and the readings where nothing was."""
    name, chapter, old, new, _, *more = mistake
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary) / "python"
        shutil.copytree(starters / "python", folder, ignore=shutil.ignore_patterns("__pycache__"))
        plant(folder, f"chapter{chapter}", old, new)
        for edit in more:
            plant(folder, *edit)
        failed = []
        for tried in range(chapter, 6):
            engine = folder / "solved" / f"chapter{tried}.py"
            ran = subprocess.run([plumb, "check", "--format", "json", "--chapter", str(tried), "--", *warm.command(engine)],
                                 capture_output=True, text=True, timeout=300)
            for result in json.loads(ran.stdout)["results"]:
                if result["verdict"] not in ("fail", "broken"):
                    continue
                failed.append(result["check"])
                if result["mistake"]:
                    return result["mistake"], result["check"], result["says"], failed
        return None, None, "", failed


def main():
    plumb, client, starters = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    mistakes, chosen = MISTAKES, sys.argv[4:]
    if chosen[:1] == ["--part"]:
        first, parts = map(int, chosen[1].split("/"))
        mistakes, chosen = MISTAKES[first - 1 :: parts], []
    named, unnamed, false = 0, [], []
    with WarmStart(client) as warm:
        for mistake in mistakes:
            if chosen and not any(word in mistake[0] for word in chosen):
                continue
            what, where, says, failed = first_named(plumb, warm, starters, mistake)
            if chosen:
                print(f"{mistake[0]}: {what} in {where}: {says} (failed: {', '.join(failed)})")
            if what in mistake[4]:
                named += 1
            elif what is None:
                unnamed.append(f"{mistake[0]} (failed: {', '.join(failed) or 'nothing'})")
            else:
                false.append(f"{mistake[0]}: {what} in {where}: {says}")
    count = named + len(unnamed) + len(false)
    print(f"{named} of {count} planted mistakes named, {len(unnamed)} not named, {len(false)} named falsely")
    for each in unnamed:
        print("  not named:", each)
    for each in false:
        print("  falsely:", each)
    return 1 if false or named < 0.95 * count else 0


if __name__ == "__main__":
    sys.exit(main())
